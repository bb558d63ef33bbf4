// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/io/deformation_quality.hpp>

#include <algorithm>
#include <cmath>

#include <skinbem/mesh/closest_point.hpp>

namespace skinbem {
namespace {

struct Edge {
  std::int32_t a, b;
  double rest_length;
};

/// Each edge once: from its lower to its higher vertex, which one of its two triangles runs along.
std::vector<Edge> edges_of(const TriangleMesh& mesh) {
  std::vector<Edge> edges;
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    for (int c = 0; c < 3; ++c) {
      const std::int32_t a = mesh.triangles(t, c), b = mesh.triangles(t, (c + 1) % 3);
      if (a < b) edges.push_back({a, b, (mesh.vertices.row(a) - mesh.vertices.row(b)).norm()});
    }
  }
  return edges;
}

double stretch_percentile(const std::vector<Edge>& edges, const Points& vertices) {
  std::vector<double> stretch;
  stretch.reserve(edges.size());
  for (const Edge& e : edges) {
    stretch.push_back(std::abs((vertices.row(e.a) - vertices.row(e.b)).norm() / e.rest_length - 1));
  }
  if (stretch.empty()) return 0;
  const auto at = stretch.begin() + static_cast<std::ptrdiff_t>(0.99 * static_cast<double>(stretch.size() - 1));
  std::nth_element(stretch.begin(), at, stretch.end());
  return *at;
}

double share_outside(const TriangleMesh& skin, const std::vector<MovingBone>& bones, Index f) {
  const Points points = bones_mesh(bones, f).vertices;
  if (points.rows() == 0) return 0;
  const SurfaceQuery query(skin);
  Index outside = 0;
  for (Index v = 0; v < points.rows(); ++v) outside += query.inside(points.row(v)) ? 0 : 1;
  return static_cast<double>(outside) / static_cast<double>(points.rows());
}

}  // namespace

std::vector<FrameQuality> deformation_quality(const SkinAnimation& skin, const std::vector<MovingBone>& bones,
                                              Index step) {
  validate(skin, bones);
  const std::vector<Edge> edges = edges_of(skin.rest);
  const double rest_volume = volume(skin.rest);
  std::vector<FrameQuality> frames(static_cast<std::size_t>((skin.frame_count() + step - 1) / step));
#pragma omp parallel for schedule(dynamic)
  for (std::size_t k = 0; k < frames.size(); ++k) {
    const Index f = static_cast<Index>(k) * step;
    const TriangleMesh mesh{skin_vertices(skin, f), skin.rest.triangles};
    frames[k] = {volume(mesh) / rest_volume - 1, stretch_percentile(edges, mesh.vertices),
                 share_outside(mesh, bones, f)};
  }
  return frames;
}

FrameQuality worst_of(const std::vector<FrameQuality>& frames) {
  FrameQuality worst;
  for (const FrameQuality& f : frames) {
    if (std::abs(f.volume_change) > std::abs(worst.volume_change)) worst.volume_change = f.volume_change;
    worst.edge_stretch = std::max(worst.edge_stretch, f.edge_stretch);
    worst.bones_outside = std::max(worst.bones_outside, f.bones_outside);
  }
  return worst;
}

}  // namespace skinbem
