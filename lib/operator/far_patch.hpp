// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A loaded patch as it acts from afar: few sources instead of all Gauss points of its triangles.
#pragma once

#include <cmath>
#include <numbers>
#include <vector>

#include <Eigen/Geometry>

#include <skinbem/kernels/panel.hpp>
#include <skinbem/operator/row_panel.hpp>

namespace skinbem::detail {

/// Sources in a box, moved to Chebyshev's nodes of the box: a kernel interpolated there is summed with the weights
/// sum_q w_q L_k(y_q) (Fong and Darve, The black-box fast multipole method, J. Comput. Phys. 228, 2009). It serves
/// field points at least `separation` half diagonals R from the centre. Interpolation errs like rho^-n in each
/// direction, with rho the ellipse that reaches to the nearest field point, 2 R away.
class FarPatch {
 public:
  static constexpr double separation = 3;

  /// `tolerance` is for the error of a source's field, relative to the largest value of the kernel in the box.
  FarPatch(const Eigen::AlignedBox3d& box, double tolerance)
      : centre_(box.center()), radius_(box.diagonal().norm() / 2) {
    constexpr double constant = 4;
    for (int k = 0; k < 3; ++k) {
      const double half = std::max(box.sizes()[k] / 2, 1e-3 * radius_);
      const double reach = 2 * radius_ / half, rho = reach + std::sqrt(reach * reach + 1);
      const int n = std::max(1, int(std::ceil(std::log(constant / tolerance) / std::log(rho))));
      for (int i = 0; i < n; ++i) {
        nodes_[k].push_back(centre_[k] + half * std::cos(std::numbers::pi * (2 * i + 1) / (2 * n)));
      }
    }
    for (const double x : nodes_[0]) {
      for (const double y : nodes_[1]) {
        for (const double z : nodes_[2]) {
          places_[0].push_back(x);
          places_[1].push_back(y);
          places_[2].push_back(z);
        }
      }
    }
    weights_.resize(places_[0].size());
    nothing_.resize(places_[0].size());
  }

  std::size_t size() const { return weights_.size(); }
  /// Half the box's diagonal: no source is nearer to a field point that is served than twice that.
  double radius() const { return radius_; }

  void add(const SourcePoints& sources) {
    for (std::size_t q = 0; q < sources.count; ++q) {
      const double weight = sources.weights[0][q] + sources.weights[1][q] + sources.weights[2][q];
      const std::vector<double> along[3] = {lagrange(nodes_[0], sources.x[q]), lagrange(nodes_[1], sources.y[q]),
                                            lagrange(nodes_[2], sources.z[q])};
      double* to = weights_.data();
      for (const double x : along[0]) {
        for (const double y : along[1]) {
          for (const double z : along[2]) *to++ += weight * x * y * z;
        }
      }
    }
  }

  bool serves(const RowPanel& panel) const {
    for (std::size_t p = 0; p < panel.count; ++p) {
      if ((panel.points.point(p) - centre_).norm() < separation * radius_) return false;
    }
    return true;
  }
  /// The weights are those of one hat function, the others' are zero.
  SourcePoints points() const {
    return {size(),
            places_[0].data(),
            places_[1].data(),
            places_[2].data(),
            {weights_.data(), nothing_.data(), nothing_.data()}};
  }

 private:
  /// Lagrange's polynomials of the nodes at x.
  static std::vector<double> lagrange(const std::vector<double>& nodes, double x) {
    std::vector<double> values(nodes.size(), 1.0);
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      for (std::size_t k = 0; k < nodes.size(); ++k) {
        if (k != i) values[i] *= (x - nodes[k]) / (nodes[i] - nodes[k]);
      }
    }
    return values;
  }

  Eigen::Vector3d centre_;
  double radius_;
  std::vector<double> nodes_[3], places_[3];
  std::vector<double> weights_, nothing_;
};

}  // namespace skinbem::detail
