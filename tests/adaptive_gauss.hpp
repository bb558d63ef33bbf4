// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A slow, plain integrator over a triangle, independent of everything that the library does near a singularity.
#pragma once

#include <Eigen/Geometry>
#include <array>

#include <skinbem/quadrature/triangle_rules.hpp>

namespace skinbem::testing_support {

using LongVector = Eigen::Matrix<long double, 3, 1>;
using LongBlock = Eigen::Matrix<long double, 3, 3>;

/// Adds the integrals of f(y - x) against the three hat functions of the root triangle over one part of it. `corners`
/// are relative to x, `hats` (column per corner) the root's hat functions there. Parts are halved across their longest
/// edge until they are no longer than their distance from x, or too small to count; then 14 x 14 Gauss points.
template <class F>
void add_adaptively(const std::array<LongVector, 3>& corners, const LongBlock& hats, const F& f, int depth,
                    std::array<LongBlock, 3>& sums) {
  static const TriangleRule rule = collapsed_triangle_rule(14);
  std::array<long double, 3> lengths;
  for (int e = 0; e < 3; ++e) lengths[e] = (corners[(e + 2) % 3] - corners[(e + 1) % 3]).norm();
  const int k = lengths[0] > lengths[1] ? (lengths[0] > lengths[2] ? 0 : 2) : (lengths[1] > lengths[2] ? 1 : 2);
  const LongVector centroid = (corners[0] + corners[1] + corners[2]) / 3;
  if (centroid.norm() > 1.7L * lengths[k] || depth == 0) {
    const long double area = (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm() / 2;
    for (int q = 0; q < rule.size(); ++q) {
      const LongVector b = rule.barycentric.col(q).cast<long double>();
      const LongBlock value = f(b[0] * corners[0] + b[1] * corners[1] + b[2] * corners[2]) * (area * rule.weights[q]);
      const LongVector hat = hats * b;
      for (int v = 0; v < 3; ++v) sums[v] += hat[v] * value;
    }
    return;
  }
  const int i = (k + 1) % 3, j = (k + 2) % 3;
  const LongVector middle = (corners[i] + corners[j]) / 2;
  const LongVector hat = (hats.col(i) + hats.col(j)) / 2;
  for (const int replaced : {i, j}) {
    auto part = corners;
    LongBlock part_hats = hats;
    part[replaced] = middle;
    part_hats.col(replaced) = hat;
    add_adaptively(part, part_hats, f, depth - 1, sums);
  }
}

/// int N_v f(y - x) dS over the triangle, v = 0, 1, 2; f takes and gives long double. Worst at x in the plane and
/// inside the triangle, where only integrands up to 1/r are allowed.
template <class F>
std::array<LongBlock, 3> integrate_adaptively(const std::array<Eigen::Vector3d, 3>& vertices, const Eigen::Vector3d& x,
                                              const F& f, int depth = 120) {
  std::array<LongVector, 3> corners;
  for (int c = 0; c < 3; ++c) corners[c] = vertices[c].cast<long double>() - x.cast<long double>();
  std::array<LongBlock, 3> sums = {LongBlock::Zero(), LongBlock::Zero(), LongBlock::Zero()};
  add_adaptively(corners, LongBlock::Identity(), f, depth, sums);
  return sums;
}

}  // namespace skinbem::testing_support
