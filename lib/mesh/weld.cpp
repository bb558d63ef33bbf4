// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/mesh/weld.hpp>

#include <bit>

namespace skinbem {
namespace {

std::uint64_t hash_of(const Points& points, Index i) {
  std::uint64_t hash = 0;
  for (int d = 0; d < 3; ++d) {
    hash ^= std::bit_cast<std::uint64_t>(points(i, d) + 0.0);  // + 0.0 turns -0 into 0
    hash *= 0x9E3779B97F4A7C15u;                               // 2^64 over the golden ratio (Fibonacci hashing)
    hash ^= hash >> 29;
  }
  return hash;
}

}  // namespace

std::vector<std::int32_t> first_equal_point(const Points& points) {
  constexpr std::int32_t vacant = -1;
  const auto slots = std::bit_ceil(static_cast<std::size_t>(2 * points.rows() + 1));
  std::vector<std::int32_t> table(slots, vacant);
  std::vector<std::int32_t> first(static_cast<std::size_t>(points.rows()));
  for (Index i = 0; i < points.rows(); ++i) {
    std::size_t slot = hash_of(points, i) & (slots - 1);
    while (table[slot] != vacant && points.row(table[slot]) != points.row(i)) slot = (slot + 1) & (slots - 1);
    if (table[slot] == vacant) table[slot] = static_cast<std::int32_t>(i);
    first[static_cast<std::size_t>(i)] = table[slot];
  }
  return first;
}

TriangleMesh welded(const TriangleMesh& mesh) {
  const std::vector<std::int32_t> first = first_equal_point(mesh.vertices);
  std::vector<std::int32_t> renumbered(first.size());
  TriangleMesh result;
  result.vertices.resize(mesh.vertex_count(), 3);
  std::int32_t kept = 0;
  for (std::size_t i = 0; i < first.size(); ++i) {
    if (first[i] == static_cast<std::int32_t>(i)) {
      result.vertices.row(kept) = mesh.vertices.row(static_cast<Index>(i));
      renumbered[i] = kept++;
    } else {
      renumbered[i] = renumbered[static_cast<std::size_t>(first[i])];
    }
  }
  result.vertices.conservativeResize(kept, 3);
  result.triangles = mesh.triangles.unaryExpr([&](std::int32_t v) { return renumbered[static_cast<std::size_t>(v)]; });
  return result;
}

}  // namespace skinbem
