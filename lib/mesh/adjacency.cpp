// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/mesh/adjacency.hpp>

#include <algorithm>
#include <limits>

namespace skinbem {

IndexLists triangles_around_vertices(const TriangleMesh& mesh) {
  std::vector<std::int32_t> offsets(static_cast<std::size_t>(mesh.vertex_count()) + 1, 0);
  for (const std::int32_t v : mesh.triangles.reshaped()) ++offsets[static_cast<std::size_t>(v) + 1];
  for (std::size_t i = 1; i < offsets.size(); ++i) offsets[i] += offsets[i - 1];
  std::vector<std::int32_t> items(static_cast<std::size_t>(mesh.triangles.size()));
  std::vector<std::int32_t> next(offsets.begin(), offsets.end() - 1);
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    for (int c = 0; c < 3; ++c) items[next[mesh.triangles(t, c)]++] = static_cast<std::int32_t>(t);
  }
  return {std::move(offsets), std::move(items)};
}

IndexLists neighbours_of_vertices(const TriangleMesh& mesh) {
  const IndexLists around = triangles_around_vertices(mesh);
  std::vector<std::int32_t> offsets{0}, items;
  offsets.reserve(static_cast<std::size_t>(mesh.vertex_count()) + 1);
  items.reserve(static_cast<std::size_t>(mesh.triangles.size()));
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const auto begin = items.size();
    for (const std::int32_t t : around[v]) {
      for (int c = 0; c < 3; ++c) {
        if (mesh.triangles(t, c) != v) items.push_back(mesh.triangles(t, c));
      }
    }
    const auto first = items.begin() + static_cast<std::ptrdiff_t>(begin);
    std::sort(first, items.end());
    items.erase(std::unique(first, items.end()), items.end());
    offsets.push_back(static_cast<std::int32_t>(items.size()));
  }
  return {std::move(offsets), std::move(items)};
}

double shortest_edge(const TriangleMesh& mesh, const IndexLists& neighbours, Index v) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const std::int32_t w : neighbours[v]) {
    shortest = std::min(shortest, (mesh.vertices.row(w) - mesh.vertices.row(v)).norm());
  }
  return shortest;
}

double mean_edge_length(const TriangleMesh& mesh, const IndexLists& neighbours) {
  double sum = 0;
  Index ends = 0;
  for (Index v = 0; v < neighbours.size(); ++v) {
    for (const std::int32_t w : neighbours[v]) sum += (mesh.vertices.row(w) - mesh.vertices.row(v)).norm();
    ends += static_cast<Index>(neighbours[v].size());
  }
  return ends > 0 ? sum / static_cast<double>(ends) : 0;
}

}  // namespace skinbem
