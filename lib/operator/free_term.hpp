// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What the jump of the double layer leaves at a corner of the surface.
#pragma once

#include <vector>

#include <skinbem/mesh/triangle_mesh.hpp>

namespace skinbem {

/// The free term c of c u + CPV int T u dS at each vertex, for Kelvin's solution: 1/2 where the surface is flat, less
/// at a convex corner. With Omega the solid angle of the body there and e1, e2, n the edges' directions from the vertex
/// and the normal of a triangle around it,
///
///   c = Omega / (4 pi) I + 1 / (8 pi (1 - nu)) sum n (n x (e2 - e1))^T,   Omega = 2 pi - sum of the edges' turns,
///
/// the integral of T over the part of a small sphere inside the body (V. Mantic, A new formula for the C-matrix in the
/// Somigliana identity, Journal of Elasticity 33, 1993); the sum is over arcs in the triangles' planes, by the
/// divergence theorem on the sphere. The mesh must bound a body.
std::vector<Mat3> free_terms(const TriangleMesh& mesh, double poisson);

}  // namespace skinbem
