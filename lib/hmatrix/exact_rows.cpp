// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/hmatrix/exact_rows.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

namespace skinbem {
namespace {

constexpr double close = 1.0 / 30;
double distance_to_singular(const Mat3& own_block) {
  return std::fmax(0, 1 / own_block.inverse().norm());  // 0 where it is not a number
}

RowMajorMatrix rows_of(const Collocation<Kelvin<double>>& collocation, const std::vector<std::int32_t>& vertices) {
  const std::int32_t n = static_cast<std::int32_t>(collocation.node_count());
  std::vector<std::int32_t> all(n);
  std::iota(all.begin(), all.end(), 0);
  RowMajorMatrix result(3 * Index(vertices.size()), 3 * Index(n));
  constexpr std::int32_t chunk = 256;
#pragma omp parallel for schedule(dynamic, 1)
  for (std::int32_t first = 0; first < n; first += chunk) {
    const std::int32_t columns = std::min(chunk, n - first);
    Eigen::MatrixXd block(result.rows(), 3 * Index(columns));
    collocation.double_layer_block(vertices, std::span(all).subspan(first, columns), block);
    result.middleCols(3 * Index(first), block.cols()) = block;
  }
  for (std::size_t k = 0; k < vertices.size(); ++k) {  // rigid translation
    Mat3 sum = Mat3::Zero();
    for (std::int32_t v = 0; v < n; ++v) sum += result.block<3, 3>(3 * Index(k), 3 * Index(v));
    result.block<3, 3>(3 * Index(k), 3 * Index(vertices[k])) = -sum;
  }
  return result;
}

RowMajorMatrix careful_rows(const Collocation<Kelvin<double>>& collocation, const std::vector<std::int32_t>& vertices) {
  constexpr double care = 1e-3;
  return rows_of(collocation.with_tolerance(care * collocation.tolerance()), vertices);
}

}  // namespace

std::vector<std::size_t> close_to_singular(std::size_t count, const std::function<Mat3(std::size_t)>& own_block) {
  constexpr std::size_t most = 64;
  std::vector<std::pair<double, std::size_t>> found;
  for (std::size_t k = 0; k < count; ++k) {
    const double distance = distance_to_singular(own_block(k));
    if (distance < close) found.push_back({distance, k});
  }
  std::sort(found.begin(), found.end());
  found.resize(std::min(found.size(), most));
  std::vector<std::size_t> numbers;
  for (const auto& [distance, k] : found) numbers.push_back(k);
  return numbers;
}

ExactRows::ExactRows(const Collocation<Kelvin<double>>& collocation, std::vector<std::int32_t> vertices)
    : vertices_(std::move(vertices)), rows_(rows_of(collocation, vertices_)) {
  const auto steep = close_to_singular(vertices_.size(), [&](std::size_t k) { return own_block(k); });
  if (steep.empty()) return;
  std::vector<std::int32_t> again;
  for (const std::size_t k : steep) again.push_back(vertices_[k]);
  const RowMajorMatrix careful = careful_rows(collocation, again);
  for (std::size_t i = 0; i < steep.size(); ++i) {
    rows_.middleRows<3>(3 * Index(steep[i])) = careful.middleRows<3>(3 * Index(i));
  }
}

Eigen::MatrixXd ExactRows::pick(const Eigen::MatrixXd& V) const {
  Eigen::MatrixXd picked(rows_.rows(), V.cols());
  for (std::size_t k = 0; k < vertices_.size(); ++k) {
    picked.middleRows<3>(3 * Index(k)) = V.middleRows<3>(3 * Index(vertices_[k]));
  }
  return picked;
}

double integrate_carefully(const Collocation<Kelvin<double>>& collocation, RowMajorMatrix& H) {
  std::vector<std::int32_t> vertices;
  for (const std::size_t k : close_to_singular(
           std::size_t(H.rows() / 3), [&](std::size_t v) { return Mat3(H.block<3, 3>(3 * Index(v), 3 * Index(v))); })) {
    vertices.push_back(std::int32_t(k));
  }
  if (vertices.empty()) return 1;
  const RowMajorMatrix careful = careful_rows(collocation, vertices);
  double nearest = close;
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    auto rows = H.middleRows<3>(3 * Index(vertices[k]));
    rows = careful.middleRows<3>(3 * Index(k));
    nearest = std::min(nearest, distance_to_singular(rows.middleCols<3>(3 * Index(vertices[k]))));
  }
  return nearest / close;
}

}  // namespace skinbem
