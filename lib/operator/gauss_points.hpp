// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A Gauss rule laid on a triangle, as the kernels' batches want it.
#pragma once

#include <vector>

#include <skinbem/kernels/panel.hpp>
#include <skinbem/quadrature/closed_form.hpp>
#include <skinbem/quadrature/triangle_rules.hpp>

namespace skinbem::detail {

/// Gauss points of one triangle for one rule, in the layout of the batches.
class GaussPoints {
 public:
  /// `density` scales the three hat functions. The points stay until the next call, and with the same triangle and rule
  /// beyond it: then the density must be the same, too.
  SourcePoints of(const TriangleGeometry<double>& g, const TriangleRule& rule, const Eigen::Vector3d& density) {
    if (triangle_ != &g || rule_ != &rule) make(g, rule, density);
    const std::size_t n = static_cast<std::size_t>(rule.size());
    const double* p = storage_.data();
    return {n, p, p + n, p + 2 * n, {p + 3 * n, p + 4 * n, p + 5 * n}};
  }

 private:
  void make(const TriangleGeometry<double>& g, const TriangleRule& rule, const Eigen::Vector3d& density) {
    const std::size_t n = static_cast<std::size_t>(rule.size());
    storage_.resize(6 * n);
    const double* b = rule.barycentric.data();
    const Eigen::Vector3d scale = density * (g.twice_area / 2);
    for (int k = 0; k < 3; ++k) {
      const double corner[3] = {g.vertices[0][k], g.vertices[1][k], g.vertices[2][k]};
      double* const place = storage_.data() + std::size_t(k) * n;
      double* const weight = place + 3 * n;
      for (std::size_t q = 0; q < n; ++q) {
        place[q] = b[3 * q] * corner[0] + b[3 * q + 1] * corner[1] + b[3 * q + 2] * corner[2];
        weight[q] = b[3 * q + std::size_t(k)] * rule.weights.data()[q] * scale[k];
      }
    }
    triangle_ = &g;
    rule_ = &rule;
  }

  const TriangleGeometry<double>* triangle_ = nullptr;
  const TriangleRule* rule_ = nullptr;
  std::vector<double> storage_;
};

}  // namespace skinbem::detail
