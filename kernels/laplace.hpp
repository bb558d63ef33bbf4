// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Fundamental solution of Laplace's equation: the second model behind the interface of kelvin.hpp.
#pragma once

#include <Eigen/Core>
#include <cmath>

#include <skinbem/kernels/constants.hpp>

namespace skinbem {

/// Potential and flux of a unit source, U = 1/(4 pi r), T = dU/dn = -(r.n)/(4 pi r^3), with r = y - x and n the outward
/// unit normal at y: c u + int T u dS = int U (du/dn) dS. Source: Brebbia, Telles, Wrobel (1984), eqs. 2.29, 2.31.
template <class T>
struct Laplace {
  using Scalar = T;
  using Vector = Eigen::Matrix<T, 3, 1>;
  using Block = Eigen::Matrix<T, 1, 1>;
  static constexpr int components = 1;
  static constexpr int single_layer_singularity = 1;
  static constexpr int double_layer_singularity = 2;

  Block single_layer(const Vector& r) const {
    using std::sqrt;
    return Block(factor() / sqrt(r.squaredNorm()));
  }

  Block double_layer(const Vector& r, const Vector& n) const {
    using std::sqrt;
    const T r2 = r.squaredNorm();
    return Block(-factor() * r.dot(n) / (r2 * sqrt(r2)));
  }

  /// int N U dS from m.inverse_distance = int N / r.
  template <class Moments>
  Block single_layer_integral(const Moments& m) const {
    return Block(factor() * m.inverse_distance);
  }

  /// int N T dS from m.solid_angle = int N (r.n) / r^3.
  template <class Moments>
  Block double_layer_integral(const Moments& m, const Vector&) const {
    return Block(-factor() * m.solid_angle);
  }

  Block free_term() const { return Block(T(1)); }

  T factor() const { return T(1) / (T(4) * pi<T>()); }
};

}  // namespace skinbem
