// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Kelvin's fundamental solution of three-dimensional linear isotropic elasticity.
///
/// A kernel is a type with
///   Scalar, components                 the kernel is a components x components matrix
///   single_layer_singularity, double_layer_singularity    p of its behaviour r^-p
///   single_layer(r), double_layer(r, n)    values at a point pair, r = y - x, n the outward unit normal at y
///   single_layer_integral(m), double_layer_integral(m, n)    the integral over a flat triangle against one hat
///                                      function, from moments of inverse powers of r (see the members)
///   free_term                          the double layer of a constant at a point inside is minus this
/// so that another model (Laplace here; Stokes is Kelvin with nu = 1/2) reuses everything above this floor. Templates
/// on the scalar: double in production, a quadruple precision type in the tests' oracle.
#pragma once

#include <Eigen/Core>

#include <cmath>

#include <skinbem/kernels/constants.hpp>

namespace skinbem {

/// Displacement and traction of a unit point force in the infinite body:
///
///   U_ij =  1/(16 pi mu (1-nu) r) [ (3-4nu) d_ij + r,i r,j ]
///   T_ij = -1/(8 pi (1-nu) r^2) { dr/dn [ (1-2nu) d_ij + 3 r,i r,j ] - (1-2nu)( r,i n_j - r,j n_i ) }
///
/// with i (row) the direction of the force at x and j (column) the component observed at y, r,i = (y_i - x_i)/r.
/// Source: Brebbia, Telles, Wrobel, Boundary Element Techniques (1984), eqs. 5.50, 5.51. U has the unit length/force, T
/// 1/area.
template <class T>
struct Kelvin {
  using Scalar = T;
  using Vector = Eigen::Matrix<T, 3, 1>;
  using Block = Eigen::Matrix<T, 3, 3>;
  static constexpr int components = 3;
  static constexpr int single_layer_singularity = 1;
  static constexpr int double_layer_singularity = 2;

  T poisson = T(0.45);     ///< nu in (-1, 1/2]
  T shear_modulus = T(1);  ///< mu > 0

  Block single_layer(const Vector& r) const {
    using std::sqrt;
    const T inverse = T(1) / sqrt(r.squaredNorm());
    const Vector e = r * inverse;
    return single_layer_factor() * inverse * ((T(3) - T(4) * poisson) * Block::Identity() + e * e.transpose());
  }

  Block double_layer(const Vector& r, const Vector& n) const {
    using std::sqrt;
    const T inverse = T(1) / sqrt(r.squaredNorm());
    const Vector e = r * inverse;
    const T slip = T(1) - T(2) * poisson;
    const Block antisymmetric = e * n.transpose() - n * e.transpose();
    return -double_layer_factor() * inverse * inverse *
           (e.dot(n) * (slip * Block::Identity() + T(3) * e * e.transpose()) - slip * antisymmetric);
  }

  /// int N U dS from m.inverse_distance = int N / r (scalar) and m.dyad = int N r r^T / r^3 (3 x 3).
  template <class Moments>
  Block single_layer_integral(const Moments& m) const {
    return single_layer_factor() * ((T(3) - T(4) * poisson) * m.inverse_distance * Block::Identity() + m.dyad);
  }

  /// int N T dS from m.solid_angle = int N (r.n) / r^3, m.attraction = int N r / r^3 (3) and m.dyad = int N 3 (r.n) r
  /// r^T / r^5.
  template <class Moments>
  Block double_layer_integral(const Moments& m, const Vector& n) const {
    const T slip = T(1) - T(2) * poisson;
    const Block antisymmetric = m.attraction * n.transpose() - n * m.attraction.transpose();
    return -double_layer_factor() * (slip * (m.solid_angle * Block::Identity() - antisymmetric) + m.dyad);
  }

  Block free_term() const { return Block::Identity(); }

  T single_layer_factor() const { return T(1) / (T(16) * pi<T>() * shear_modulus * (T(1) - poisson)); }
  T double_layer_factor() const { return T(1) / (T(8) * pi<T>() * (T(1) - poisson)); }
};

}  // namespace skinbem
