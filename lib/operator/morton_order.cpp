// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/operator/morton_order.hpp>

#include <algorithm>
#include <limits>
#include <numeric>

namespace skinbem::detail {
namespace {

/// Spreads the low 21 bits of v to every third bit.
std::uint64_t spread_bits(std::uint64_t v) {
  v = (v | v << 32) & 0x1f00000000ffffull;
  v = (v | v << 16) & 0x1f0000ff0000ffull;
  v = (v | v << 8) & 0x100f00f00f00f00full;
  v = (v | v << 4) & 0x10c30c30c30c30c3ull;
  return (v | v << 2) & 0x1249249249249249ull;
}

}  // namespace

std::vector<std::int32_t> morton_order(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d low = points.front(), high = points.front();
  for (const auto& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double cells = 2097151 / std::max((high - low).maxCoeff(), std::numeric_limits<double>::min());
  std::vector<std::uint64_t> code(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d cell = (points[i] - low) * cells;
    code[i] = spread_bits(static_cast<std::uint64_t>(cell[0])) | spread_bits(static_cast<std::uint64_t>(cell[1])) << 1 |
              spread_bits(static_cast<std::uint64_t>(cell[2])) << 2;
  }
  std::vector<std::int32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return code[a] < code[b]; });
  return order;
}

}  // namespace skinbem::detail
