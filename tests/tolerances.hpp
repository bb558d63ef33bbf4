// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Every tolerance of the tests, each with its reason. Relative to the largest entry of what is compared, unless said.
#pragma once

namespace skinbem::tolerance {

/// A short chain of additions and products in double.
inline constexpr double rounding = 1e-14;
/// Sums of some hundred terms of size 1.
inline constexpr double rounding_of_sums = 1e-12;
/// The same on a body of size 1 at a distance of 3000: its coordinates carry 3000 times the rounding.
inline constexpr double rounding_far_away = 1e-11;
/// A moment of a quadrature rule: at most some hundred positive terms of sum below one, each rounded once.
inline constexpr double quadrature_rule = 2e-15;

/// A frame in float against its exact value: a few roundings of single precision, relative to the largest coordinate.
inline constexpr double frame_rigid = 1e-6;
/// The same in double, of landmark positions that were themselves rounded.
inline constexpr double frame_reference = 1e-12;

/// Handles against R of the same landmarks, relative to the body's size for pulls of a tenth of it: Green's functions
/// and their weights in single precision, which cancel where handles are neighbours.
inline constexpr double handles = 2e-5;

/// What the interpolation to a finer skin promises of fields u = a + F x.
inline constexpr double affine = 1e-10;
/// The finer skin at a coarse vertex: ties are springs 1e4 times as stiff as the field; random values, the worst case.
inline constexpr double interpolation_tie = 1e-3;
/// Times the conditioning of an element integral (its change when v - x is rounded to double): what an algorithm of a
/// dozen steps in double may lose.
inline constexpr double conditioning = 30;
/// The closed form loses digits like (distance / height)^2; here distance <= 1.8, times height^-2.
inline constexpr double closed_form_against_gauss = 1e-11;

/// A mean or deviation of 20000 draws of deviation 1: six standard errors of a mean.
inline constexpr double sampling = 0.043;
/// A motion by rig and file: rotations from angles and cross products, then points a few units away, in units of their
/// size.
inline constexpr double motion = 1e-12;
/// Winding numbers of the tests' small meshes with far triangles as dipoles (scanned meshes: 0.023 at worst); a
/// decision needs 0.5.
inline constexpr double winding_number = 2e-2;

/// Numbers stored as float in a file, a dozen of them combined: some roundings of single precision.
inline constexpr double float_file = 2e-6;
/// A derivative against central differences of step 1e-3 on a body of size 100.
inline constexpr double central_difference = 1e-6;

/// Central differences with step 1e-6 in long double: the step's square times the third derivative.
inline constexpr double finite_difference = 1e-10;
/// A batch against the scalar kernel, relative to the largest entry of the block: an inverse root by Newton's steps (a
/// few units of the last place, cubed) and seven Gauss points.
inline constexpr double batch = 1e-14;
/// The same with far points in single precision: some roundings of 6e-8 where the nine entries do not cancel.
inline constexpr double single_precision_batch = 3e-6;

/// An error smaller than this part of the tolerance is work that nobody asked for.
inline constexpr double waste = 0.01;
/// H and G of 42 nodes against long double, absolute: entries up to 0.5, from about six element integrals each.
inline constexpr double reference_matrix = 1e-13;
/// H of a rigid rotation, H u = G t of a constant strain: N element integrals, each right to some 1e-14.
inline constexpr double identity = 1e-12;
/// Order in h expected of the P1 method (2), less what two meshes that are not yet in the asymptotic range may show.
inline constexpr double observed_order = 1.6;

/// R by Green's functions against the mixed system, and tractions: two factorisations, condition up to some thousand,
/// integrals to 1e-13 or 1e-12.
inline constexpr double mixed_system = 1e-10;
/// The same on a slab of 1:50, whose bending amplifies what H leaves of a rotation.
inline constexpr double mixed_system_of_a_slab = 1e-8;
/// R of the same body, moved or renumbered: other roundings and other quadrature rules of tolerance 1e-11.
inline constexpr double invariance = 1e-10;
/// Asymmetry of the landmarks' forces on an ellipsoid of 642 vertices.
inline constexpr double reciprocity = 0.02;
/// Response of a sphere of 162 vertices against one of 642, landmarks of 0.8 radii: discretisation, measured 0.007.
inline constexpr double refined_sphere = 0.01;
/// Response of the real leg of 606 vertices against that of 2,000, landmarks of 45 mm: discretisation of both surfaces
/// and landmarks that moved by up to 6 mm; measured 0.10 (points: 0.14).
inline constexpr double leg_of_2k = 0.12;
/// Integrals of (1 - s^2)^2 with pieces of up to a quarter of the radius on which it is linear (measured: 0.03).
inline constexpr double smooth_load = 0.05;
/// A discretisation error that is known to three or four digits.
inline constexpr double known_error = 0.005;
/// Error with curved displacements, in those with linear ones: a sphere of 162 vertices (measured: 0.15 to 0.21), cubes
/// of 98 and 386 in bending, where gradients at edges lie to one side (0.19 to 0.57).
inline constexpr double curved_on_sphere = 0.25;
inline constexpr double curved_at_edges = 0.6;
/// A field that the method represents exactly, solved for: rounding and quadrature (1e-11) times the condition.
inline constexpr double neumann_solve = 1e-9;
/// The finer skin at the coarse vertices, mm, where the skin moves by tens of millimetres: see interpolation_tie.
inline constexpr double finer_skin = 0.05;
/// R written by the program with --tolerance 1e-10, against the exactly integrated one: what the option promises.
inline constexpr double program_response = 1e-10;

/// A product of a tile in single precision with random numbers, per root of its depth: its slices' roundings of 6e-8.
inline constexpr double tile_product_f32 = 1e-6;
/// The compressed matrix's numbers and sums in single precision, of columns of size 1.
inline constexpr double compressed_f32 = 2e-6;
/// The same of numbers in 16 bits: the largest of a column err by 1/32767 of it, the others less.
inline constexpr double compressed_packed = 2e-5;
/// Error of a compressed response, in tolerances asked for and in errors estimated (measured: 0.6 and 0.7).
inline constexpr double compressed_response = 1;
inline constexpr double compressed_estimate = 1;
/// What a leaf's dipoles miss where they were not fitted, in tolerances of the bases; a new basis is made where a few
/// random places miss two (measured: 4.1, without that 6.9).
inline constexpr double missed_by_dipoles = 5;
/// Area that samples at random stand for, on the mean of some dozen leaves.
inline constexpr double random_area = 0.2;
/// What compression reaches, whatever is asked: normal equations.
inline constexpr double compression = 3e-6;
/// Residual of the dense matrix after a solve with the compressed one, in residuals asked for: a slab of 1:25 bends a
/// thousand times as much as it stretches, and so grows what compression left (measured: 19).
inline constexpr double compression_in_bending = 30;
/// Columns chosen and expressed through A^T A, whose rounding is the square root of that of A.
inline constexpr double normal_equations = 1e-7;
/// Predicted against real bytes of a compressed matrix, whose ranks are guessed: a factor.
inline constexpr double predicted_bytes = 2;

/// A smooth surface through the 162 vertices of a sphere, between them: half of the facets' own distance, 0.01.
inline constexpr double loop_sphere = 5e-3;
/// A sparse Cholesky factorisation in double of a body of some hundred nodes: conditioned like (size / edge)^2 and,
/// near Poisson's ratio 1/2, like lambda / mu.
inline constexpr double finite_elements = 1e-9;
/// Finite against boundary elements on a sphere of 642 vertices: the discretisation errors of both (measured: 0.062).
inline constexpr double finite_against_boundary_elements = 8e-2;

}  // namespace skinbem::tolerance
