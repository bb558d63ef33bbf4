// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/hmatrix/exact_rows.hpp>

#include <algorithm>
#include <numeric>

namespace skinbem {

ExactRows::ExactRows(const Collocation<Kelvin<double>>& collocation, std::vector<std::int32_t> vertices)
    : vertices_(std::move(vertices)) {
  const std::int32_t n = static_cast<std::int32_t>(collocation.node_count());
  std::vector<std::int32_t> all(n);
  std::iota(all.begin(), all.end(), 0);
  const Index rows = 3 * Index(vertices_.size());
  rows_.resize(rows, 3 * Index(n));
  constexpr std::int32_t chunk = 256;
#pragma omp parallel for schedule(dynamic, 1)
  for (std::int32_t first = 0; first < n; first += chunk) {
    const std::int32_t columns = std::min(chunk, n - first);
    Eigen::MatrixXd block(rows, 3 * Index(columns));
    collocation.double_layer_block(vertices_, std::span(all).subspan(first, columns), block);
    rows_.middleCols(3 * Index(first), block.cols()) = block;
  }
  for (std::size_t k = 0; k < vertices_.size(); ++k) {  // rigid translation
    Mat3 sum = Mat3::Zero();
    for (std::int32_t v = 0; v < n; ++v) sum += rows_.block<3, 3>(3 * Index(k), 3 * Index(v));
    rows_.block<3, 3>(3 * Index(k), 3 * Index(vertices_[k])) = -sum;
  }
}

Eigen::MatrixXd ExactRows::pick(const Eigen::MatrixXd& V) const {
  Eigen::MatrixXd picked(rows_.rows(), V.cols());
  for (std::size_t k = 0; k < vertices_.size(); ++k) {
    picked.middleRows<3>(3 * Index(k)) = V.middleRows<3>(3 * Index(vertices_[k]));
  }
  return picked;
}

}  // namespace skinbem
