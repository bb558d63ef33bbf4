// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Some rows of H without compression: to measure what it costs, and for vertices that cannot afford it.
#pragma once

#include <functional>
#include <vector>

#include <skinbem/operator/collocation.hpp>

namespace skinbem {

/// Numbers below `count` whose vertex's block D with itself is close to singular: at the tip of a needle, or where
/// slivers meet. What is wrong with its equations is multiplied by D^-1. Those with 1 / |D^-1| below 1/30, where a flat
/// place has 0.3; the worst first, at most 64.
std::vector<std::size_t> close_to_singular(std::size_t count, const std::function<Mat3(std::size_t)>& own_block);

/// The rows of H that belong to some vertices: 3 #vertices by 3N numbers. Their own blocks make H 1 = 0. Rows whose own
/// block is close to singular are integrated to a thousandth of the collocation's tolerance.
class ExactRows {
 public:
  ExactRows(const Collocation<Kelvin<double>>& collocation, std::vector<std::int32_t> vertices);

  const std::vector<std::int32_t>& vertices() const { return vertices_; }
  const RowMajorMatrix& rows() const { return rows_; }
  /// The 3 by 3 block of vertex number k with itself.
  Mat3 own_block(std::size_t k) const { return rows_.block<3, 3>(3 * Index(k), 3 * Index(vertices_[k])); }
  /// Those rows of H V, V of 3N rows in the order of the mesh.
  Eigen::MatrixXd multiply(const Eigen::MatrixXd& V) const { return rows_ * V; }
  /// Those rows of V.
  Eigen::MatrixXd pick(const Eigen::MatrixXd& V) const;

 private:
  std::vector<std::int32_t> vertices_;
  RowMajorMatrix rows_;
};

/// Replaces the rows of a dense H whose own block is close to singular by such rows. Returns how close the worst is: 1
/// where there is none, else 30 / |D^-1|; residuals should be as much smaller.
double integrate_carefully(const Collocation<Kelvin<double>>& collocation, RowMajorMatrix& H);

}  // namespace skinbem
