// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Who is next to whom on the surface.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <skinbem/mesh/triangle_mesh.hpp>

namespace skinbem {

/// Lists of indices, one a vertex, stored one after the other.
class IndexLists {
 public:
  IndexLists(std::vector<std::int32_t> offsets, std::vector<std::int32_t> items)
      : offsets_(std::move(offsets)), items_(std::move(items)) {}

  Index size() const { return static_cast<Index>(offsets_.size()) - 1; }
  std::span<const std::int32_t> operator[](Index i) const {
    const auto row = static_cast<std::size_t>(i);
    return {items_.data() + offsets_[row], items_.data() + offsets_[row + 1]};
  }

 private:
  std::vector<std::int32_t> offsets_;  // #lists + 1
  std::vector<std::int32_t> items_;
};

/// #V lists: the triangles that have the vertex as a corner, ascending.
IndexLists triangles_around_vertices(const TriangleMesh& mesh);
/// #V lists: the vertices at the other ends of the vertex's edges, ascending, each once.
IndexLists neighbours_of_vertices(const TriangleMesh& mesh);

/// Length of the shortest edge at vertex `v`; infinite without neighbours.
double shortest_edge(const TriangleMesh& mesh, const IndexLists& neighbours, Index v);
/// Mean length of the edges, each counted once; 0 without edges.
double mean_edge_length(const TriangleMesh& mesh, const IndexLists& neighbours);

}  // namespace skinbem
