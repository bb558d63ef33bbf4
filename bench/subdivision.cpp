// SPDX-License-Identifier: BSD-3-Clause
#include "subdivision.hpp"

#include <algorithm>
#include <cmath>
#include <numbers>
#include <skinbem/base/error.hpp>
#include <skinbem/mesh/adjacency.hpp>
#include <unordered_map>

namespace skinbem::bench {
namespace {

/// Loop's weight of each of n neighbours in a vertex's new place.
double neighbour_weight(double n) {
  const double c = 0.375 + 0.25 * std::cos(2 * std::numbers::pi / n);
  return (0.625 - c * c) / n;
}

/// A control net and who is around whom.
struct Net {
  explicit Net(TriangleMesh net) : mesh(std::move(net)), neighbours(neighbours_of_vertices(mesh)) {}

  TriangleMesh mesh;
  IndexLists neighbours;

  /// Vertex v moved towards the mean of its neighbours: by n times a weight of each.
  template <class Weight>
  Points smoothed(const Weight& weight) const {
    Points result = mesh.vertices;
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const double w = weight(static_cast<double>(neighbours[v].size()));
      for (const std::int32_t i : neighbours[v]) result.row(v) += w * (mesh.vertices.row(i) - mesh.vertices.row(v));
    }
    return result;
  }

  /// Where the vertices are on the limit surface.
  Points limit() const {
    return smoothed([](double n) { return 1 / (n + 0.375 / neighbour_weight(n)); });
  }
};

/// The control net, joined like the skin, whose limit passes through the skin's vertices.
Net control_net(const TriangleMesh& skin) {
  constexpr int most_steps = 500;
  constexpr double exact = 1e-14;  // of the diagonal
  Net net(skin);
  for (int step = 0; step < most_steps; ++step) {
    const Points missing = skin.vertices - net.limit();
    if (missing.cwiseAbs().maxCoeff() <= exact * diagonal(skin)) return net;
    net.mesh.vertices += missing;
  }
  throw Error(ErrorCode::numerical, "no smooth surface was found through the vertices of the skin");
}

/// Loop's subdivision: a vertex more on every edge, four triangles for one.
Net subdivided(const Net& net) {
  const TriangleMesh& coarse = net.mesh;
  std::unordered_map<std::int64_t, std::int32_t> middles;
  const Index old_count = coarse.vertex_count(), edges = 3 * coarse.triangle_count() / 2;
  TriangleMesh fine;
  fine.vertices = Points::Zero(old_count + edges, 3);
  fine.triangles.resize(4 * coarse.triangle_count(), 3);
  fine.vertices.topRows(old_count) = net.smoothed(neighbour_weight);
  // Each of an edge's two triangles adds 3/16 of both ends and 1/8 of the corner opposite.
  const auto middle = [&](std::int32_t a, std::int32_t b, std::int32_t opposite) {
    const std::int64_t key = std::int64_t(std::min(a, b)) * old_count + std::max(a, b);
    const std::int32_t m =
        middles.try_emplace(key, static_cast<std::int32_t>(old_count + middles.size())).first->second;
    fine.vertices.row(m) +=
        0.1875 * (coarse.vertices.row(a) + coarse.vertices.row(b)) + 0.125 * coarse.vertices.row(opposite);
    return m;
  };
  for (Index t = 0; t < coarse.triangle_count(); ++t) {
    const auto a = coarse.triangles(t, 0), b = coarse.triangles(t, 1), c = coarse.triangles(t, 2);
    const auto ab = middle(a, b, c), bc = middle(b, c, a), ca = middle(c, a, b);
    fine.triangles.middleRows<4>(4 * t) << a, ab, ca, b, bc, ab, c, ca, bc, ab, bc, ca;
  }
  return Net(std::move(fine));
}

}  // namespace

std::vector<TriangleMesh> smooth_refinements(const TriangleMesh& skin, int times) {
  Net net = control_net(skin);
  std::vector<TriangleMesh> meshes{skin};
  for (int level = 1; level <= times; ++level) {
    net = subdivided(net);
    TriangleMesh mesh{net.limit(), net.mesh.triangles};
    // The limit of a vertex is the same at every level up to rounding; now in every bit.
    const Points& coarse = meshes.back().vertices;
    mesh.vertices.topRows(coarse.rows()) = coarse;
    meshes.push_back(std::move(mesh));
  }
  return meshes;
}

}  // namespace skinbem::bench
