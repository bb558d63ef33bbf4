// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/mesh/surface_topology.hpp>

#include <algorithm>
#include <numeric>
#include <tuple>

namespace skinbem {
namespace {

/// Edge of a triangle, as the triangle runs through it.
struct HalfEdge {
  std::array<std::int32_t, 2> vertices;  // ascending
  std::int32_t triangle;
  bool ascending;
};

std::vector<HalfEdge> sorted_half_edges(const TriangleMesh& mesh, const std::vector<std::int32_t>& triangles) {
  std::vector<HalfEdge> edges;
  edges.reserve(3 * triangles.size());
  for (const std::int32_t t : triangles) {
    for (int c = 0; c < 3; ++c) {
      const std::int32_t a = mesh.triangles(t, c), b = mesh.triangles(t, (c + 1) % 3);
      edges.push_back({{std::min(a, b), std::max(a, b)}, t, a < b});
    }
  }
  std::sort(edges.begin(), edges.end(), [](const HalfEdge& a, const HalfEdge& b) {
    return std::tie(a.vertices, a.triangle) < std::tie(b.vertices, b.triangle);
  });
  return edges;
}

/// Union-find over triangles that knows of each whether it faces as the root does or the other way.
class Components {
 public:
  explicit Components(Index count) : parent_(static_cast<std::size_t>(count)), turned_(parent_.size(), 0) {
    std::iota(parent_.begin(), parent_.end(), 0);
  }
  struct Root {
    std::int32_t triangle;
    char turned;
  };
  Root find(std::int32_t t) {
    std::int32_t root = t;
    char turned = 0;
    while (parent_[root] != root) {
      turned ^= turned_[root];
      root = parent_[root];
    }
    char rest = turned;
    while (parent_[t] != root && t != root) {  // compress the path
      const std::int32_t next = parent_[t];
      const char own = turned_[t];
      parent_[t] = root;
      turned_[t] = rest;
      rest ^= own;
      t = next;
    }
    return {root, turned};
  }
  /// False when s and t were already joined the other way round.
  bool join(std::int32_t s, std::int32_t t, bool turned) {
    const Root a = find(s), b = find(t);
    const char between = static_cast<char>(a.turned ^ b.turned ^ (turned ? 1 : 0));
    if (a.triangle == b.triangle) return between == 0;
    parent_[std::max(a.triangle, b.triangle)] = std::min(a.triangle, b.triangle);
    turned_[std::max(a.triangle, b.triangle)] = between;
    return true;
  }

 private:
  std::vector<std::int32_t> parent_;
  std::vector<char> turned_;  // against the parent
};

void sort_edges_out(const std::vector<HalfEdge>& edges, Components& components, SurfaceTopology& result) {
  for (std::size_t begin = 0, end = 0; begin < edges.size(); begin = end) {
    while (end < edges.size() && edges[end].vertices == edges[begin].vertices) ++end;
    const HalfEdge& first = edges[begin];
    const auto count = static_cast<Index>(end - begin);
    if (count == 1) result.open_edges.push_back({first.vertices, first.triangle, count});
    if (count > 2) result.crowded_edges.push_back({first.vertices, first.triangle, count});
    if (count != 2) continue;
    const HalfEdge& second = edges[begin + 1];
    const bool turned = second.ascending == first.ascending;
    if (!components.join(first.triangle, second.triangle, turned)) result.one_sided.push_back(first.vertices);
  }
}

/// The smaller part of each component is taken for the one to turn.
void find_flipped(const std::vector<std::int32_t>& triangles, Components& components, SurfaceTopology& result) {
  std::vector<std::array<Index, 2>> sides(static_cast<std::size_t>(result.component_count), {0, 0});
  for (const std::int32_t t : triangles) ++sides[result.component[t]][components.find(t).turned];
  for (const std::int32_t t : triangles) {
    const auto& side = sides[result.component[t]];
    const int minority = side[1] <= side[0] ? 1 : 0;
    if (components.find(t).turned == minority) result.flipped.push_back(t);
  }
}

/// Vertices whose triangles are not connected through common edges at the vertex.
std::vector<std::int32_t> find_pinched(const TriangleMesh& mesh, const std::vector<std::int32_t>& triangles) {
  std::vector<std::int32_t> offsets(static_cast<std::size_t>(mesh.vertex_count()) + 1, 0);
  for (const std::int32_t t : triangles) {
    for (int c = 0; c < 3; ++c) ++offsets[mesh.triangles(t, c) + 1];
  }
  for (std::size_t i = 1; i < offsets.size(); ++i) offsets[i] += offsets[i - 1];
  std::vector<std::array<std::int32_t, 2>> opposite(static_cast<std::size_t>(offsets.back()));  // edges across
  std::vector<std::int32_t> next(offsets.begin(), offsets.end() - 1);
  for (const std::int32_t t : triangles) {
    for (int c = 0; c < 3; ++c) {
      opposite[next[mesh.triangles(t, c)]++] = {mesh.triangles(t, (c + 1) % 3), mesh.triangles(t, (c + 2) % 3)};
    }
  }
  std::vector<std::int32_t> pinched;
  std::vector<std::array<std::int32_t, 2>> rest;
  std::vector<std::int32_t> reached;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    rest.assign(opposite.begin() + offsets[v], opposite.begin() + offsets[v + 1]);
    if (rest.empty()) continue;
    reached.assign({rest.back()[0], rest.back()[1]});
    rest.pop_back();
    for (std::size_t r = 0; r < reached.size(); ++r) {  // walk along the edges across until nothing new is met
      for (std::size_t i = 0; i < rest.size();) {
        const bool first = rest[i][0] == reached[r], second = rest[i][1] == reached[r];
        if (!first && !second) {
          ++i;
          continue;
        }
        reached.push_back(rest[i][first ? 1 : 0]);
        rest[i] = rest.back();
        rest.pop_back();
      }
    }
    if (!rest.empty()) pinched.push_back(static_cast<std::int32_t>(v));
  }
  return pinched;
}

}  // namespace

SurfaceTopology surface_topology(const TriangleMesh& mesh, const std::vector<std::int32_t>& triangles) {
  SurfaceTopology result;
  Components components(mesh.triangle_count());
  sort_edges_out(sorted_half_edges(mesh, triangles), components, result);
  result.component.assign(static_cast<std::size_t>(mesh.triangle_count()), -1);
  for (const std::int32_t t : triangles) {  // ascending, and a root is the lowest of its component
    const std::int32_t root = components.find(t).triangle;
    result.component[t] = root == t ? result.component_count++ : result.component[root];
  }
  find_flipped(triangles, components, result);
  result.pinched_vertices = find_pinched(mesh, triangles);
  return result;
}

}  // namespace skinbem
