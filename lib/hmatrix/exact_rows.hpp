// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Some rows of H without compression: to measure what it costs, and for vertices that cannot afford it.
#pragma once

#include <vector>

#include <skinbem/operator/collocation.hpp>

namespace skinbem {

/// The rows of H that belong to some vertices: 3 #vertices by 3N numbers. Their own blocks make H 1 = 0.
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

}  // namespace skinbem
