// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Kelvin's element integrals by the near-singular rule, as the tests compare them.
#pragma once

#include <skinbem/kernels/kelvin.hpp>
#include <skinbem/quadrature/near_singular.hpp>

#include "../../bench/quadrature_cases.hpp"

namespace skinbem::testing_support {

inline ElementBlocks near_singular_blocks(const TriangleGeometry<double>& triangle, const Eigen::Vector3d& x, double nu,
                                          double tolerance) {
  const Kelvin<double> kernel{nu, 1.0};
  const NearSingularRule rule(triangle, x, tolerance);
  ElementBlocks sum;
  sum.U.fill(Eigen::Matrix3d::Zero());
  sum.T.fill(Eigen::Matrix3d::Zero());
  rule.for_each([&](const Eigen::Vector3d& r, const Eigen::Vector3d& hats, double weight) {
    const Eigen::Matrix3d U = kernel.single_layer(r), T = kernel.double_layer(r, Eigen::Vector3d::UnitZ());
    for (int v = 0; v < 3; ++v) {
      sum.U[v] += weight * hats[v] * U;
      sum.T[v] += weight * hats[v] * T;
    }
  });
  const Eigen::Matrix3d& F = rule.frame();
  for (int v = 0; v < 3; ++v) {
    sum.U[v] = (F.transpose() * sum.U[v] * F).eval();
    sum.T[v] = (F.transpose() * sum.T[v] * F).eval();
  }
  return sum;
}

inline TriangleGeometry<double> geometry_of(const QuadratureCase& c) {
  return {c.vertices[0], c.vertices[1], c.vertices[2]};
}

}  // namespace skinbem::testing_support
