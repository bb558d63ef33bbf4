// SPDX-License-Identifier: BSD-3-Clause
// A kernel of your own: the pseudo-traction of elasticity.
//
// The double layer of elasticity is not unique: Kupradze's pseudo-stress operator belongs to the same displacements and
// has no antisymmetric part, so its kernel is only weakly singular on a smooth surface. Everything that the operator
// needs to know of a kernel is in this type; near integrals are written in moments that quadrature knows in closed
// form.
#pragma once

#include <numbers>
#include <skinbem/kernels/kelvin.hpp>

/// T_ij = -(r.n) / (4 pi (3-4nu) r^3) [ 2 (1-2nu) d_ij + 3 r,i r,j ]; the single layer is Kelvin's, mu = 1.
/// Source: Kupradze, Three-Dimensional Problems of the Mathematical Theory of Elasticity (1979), the operator N.
struct PseudoTraction : skinbem::Kelvin<double> {
  Block double_layer(const Vector& r, const Vector& n) const {
    const double r2 = r.squaredNorm();
    return -factor() * r.dot(n) / (r2 * std::sqrt(r2)) *
           ((2 - 4 * poisson) * Block::Identity() + 3 * r * r.transpose() / r2);
  }
  /// The same, integrated against a hat function: see kernels/kelvin.hpp for the moments.
  template <class Moments>
  Block double_layer_integral(const Moments& m, const Vector&) const {
    return -factor() * ((2 - 4 * poisson) * m.solid_angle * Block::Identity() + m.dyad);
  }
  double factor() const { return 1 / (4 * std::numbers::pi * (3 - 4 * poisson)); }
};
