// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/hmatrix/exact_rows.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

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

Eigen::RowVectorXd ExactRows::estimate_norms(const Eigen::MatrixXd& sampled) const {
  return sampled.colwise().norm() * std::sqrt(double(rows_.cols()) / double(rows_.rows()));
}

std::vector<std::int32_t> random_vertices(Index vertex_count, std::size_t count) {
  std::vector<std::int32_t> all(vertex_count);
  std::iota(all.begin(), all.end(), 0);
  std::mt19937 generator(1);
  count = std::min(count, all.size());
  for (std::size_t k = 0; k < count; ++k) std::swap(all[k], all[k + generator() % (all.size() - k)]);
  all.resize(count);
  return all;
}

}  // namespace skinbem
