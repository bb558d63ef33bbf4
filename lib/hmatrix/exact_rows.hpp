// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Some rows of H without compression, to measure what compression costs.
#pragma once

#include <vector>

#include <skinbem/operator/collocation.hpp>

namespace skinbem {

/// The rows of H that belong to `count` vertices drawn at random (the same for the same mesh): 3 count by 3N numbers.
class ExactRows {
 public:
  static constexpr std::size_t default_count = 16;

  explicit ExactRows(const Collocation<Kelvin<double>>& collocation, std::size_t count = default_count);

  /// Those rows of H V, V of 3N rows in the order of the mesh.
  Eigen::MatrixXd multiply(const Eigen::MatrixXd& V) const { return rows_ * V; }
  /// Those rows of V.
  Eigen::MatrixXd pick(const Eigen::MatrixXd& V) const;
  /// The root mean square of a sampled difference, taken as that of all rows: an estimate of each column's norm.
  Eigen::RowVectorXd estimate_norms(const Eigen::MatrixXd& sampled) const;

 private:
  std::vector<std::int32_t> vertices_;
  RowMajorMatrix rows_;
};

}  // namespace skinbem
