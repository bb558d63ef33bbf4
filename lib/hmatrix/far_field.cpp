// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/hmatrix/far_field.hpp>

#include <algorithm>
#include <cmath>

#include <skinbem/kernels/kelvin_batch.hpp>
#include <skinbem/mesh/adjacency.hpp>

namespace skinbem {
namespace {

constexpr std::int32_t most_representatives = 32;

/// The first vertices of a walk that always goes to the one farthest from those seen so far.
std::vector<std::int32_t> spread_out(const Points& vertices, const std::vector<std::int32_t>& order,
                                     const std::vector<std::int32_t>& candidates) {
  const auto at = [&](std::int32_t place) { return vertices.row(order[place]); };
  std::vector<double> distance2(candidates.size(), std::numeric_limits<double>::infinity());
  std::vector<std::int32_t> chosen;
  std::size_t next = candidates.size() / 2;
  while (chosen.size() < std::min<std::size_t>(most_representatives, candidates.size())) {
    chosen.push_back(candidates[next]);
    for (std::size_t k = 0; k < candidates.size(); ++k) {
      distance2[k] = std::min(distance2[k], (at(candidates[k]) - at(chosen.back())).squaredNorm());
    }
    next = std::max_element(distance2.begin(), distance2.end()) - distance2.begin();
  }
  return chosen;
}

/// By cluster: vertices that represent it, the first few of them too.
std::vector<std::vector<std::int32_t>> representatives(const TriangleMesh& mesh, const ClusterTree& tree) {
  const auto& clusters = tree.clusters();
  std::vector<std::vector<std::int32_t>> result(clusters.size());
  for (std::size_t c = clusters.size(); c-- > 0;) {
    std::vector<std::int32_t> candidates;
    if (clusters[c].is_leaf()) {
      for (std::int32_t k = clusters[c].begin; k < clusters[c].end; ++k) candidates.push_back(k);
    } else {
      for (const std::int32_t child : clusters[c].children) {
        candidates.insert(candidates.end(), result[child].begin(), result[child].end());
      }
    }
    result[c] = spread_out(mesh.vertices, tree.order(), candidates);
  }
  return result;
}

/// Every so many of the samples, so that about `count` are left.
void add_thinned(const FarSamples& from, std::size_t count, FarSamples& to) {
  const std::size_t used = std::count_if(from.area_root.begin(), from.area_root.end(), [](double w) { return w > 0; });
  if (used == 0) return;
  const std::size_t step = std::max<std::size_t>(1, used / count);
  const double factor = std::sqrt(static_cast<double>(step));
  for (std::size_t k = 0; k < used; k += step) {
    to.places.push_back(from.places[k]);
    to.area_root.push_back(from.area_root[k] * factor);
  }
}

}  // namespace

template <class Kernel>
PointKernel<Kernel>::PointKernel(const TriangleMesh& mesh, const ClusterTree& tree, const Kernel& kernel)
    : kernel_(kernel) {
  const double scale = unit_scale(mesh);
  for (const std::int32_t vertex : tree.order()) vertices_.push_back(mesh.vertices.row(vertex).transpose() * scale);
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    centroids_.push_back((mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2)) / 3 * scale);
    normals_.push_back(area_vector(mesh, t).normalized());
  }
}

template <class Kernel>
const double* PointKernel<Kernel>::values(std::span<const std::int32_t> points,
                                          std::span<const std::int32_t> sources) const {
  thread_local std::vector<double> source[6];
  thread_local detail::AlignedVector<double> result;
  for (auto& s : source) s.resize(sources.size());
  for (std::size_t q = 0; q < sources.size(); ++q) {
    for (int k = 0; k < 3; ++k) {
      source[k][q] = centroids_[sources[q]][k];
      source[3 + k][q] = normals_[sources[q]][k];
    }
  }
  const Dipoles dipoles = {sources.size(),
                           source[0].data(),
                           source[1].data(),
                           source[2].data(),
                           {source[3].data(), source[4].data(), source[5].data()}};
  const std::size_t panels = (points.size() + kPanel - 1) / kPanel;
  const std::size_t numbers = sources.size() * components * components * kPanel;
  if (result.size() < panels * numbers) result.resize(panels * numbers);
  for (std::size_t panel = 0; panel < panels; ++panel) {
    PointPanel field;
    for (std::size_t p = 0; p < kPanel; ++p) {
      const auto& x = vertices_[points[std::min(panel * kPanel + p, points.size() - 1)]];
      field.x[p] = x[0];
      field.y[p] = x[1];
      field.z[p] = x[2];
    }
    double_layer_of_dipoles(kernel_, field, dipoles, result.data() + panel * numbers);
  }
  return result.data();
}

std::vector<FarSamples> sample_far_fields(const TriangleMesh& mesh, const ClusterTree& tree,
                                          const BlockPartition& partition, Index samples_per_cluster) {
  const auto& clusters = tree.clusters();
  const std::vector<std::vector<std::int32_t>> represent = representatives(mesh, tree);
  const IndexLists triangles = triangles_around_vertices(mesh);
  const Eigen::VectorXd area_of_vertex = vertex_areas(mesh);
  std::vector<double> areas(clusters.size());
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    for (std::int32_t k = clusters[c].begin; k < clusters[c].end; ++k) areas[c] += area_of_vertex[tree.order()[k]];
  }
  std::vector<FarSamples> samples(clusters.size());
  for (std::size_t c = 0; c < clusters.size(); ++c) {
    const auto& partners = partition.far[c];
    FarSamples& own = samples[c];
    const std::size_t inherited = static_cast<std::size_t>(samples_per_cluster) / 3;
    for (const std::int32_t partner : partners) {
      const std::size_t share = (static_cast<std::size_t>(samples_per_cluster) - inherited) / partners.size() + 1;
      const std::size_t count = std::min(represent[partner].size(), std::max<std::size_t>(4, share));
      for (std::size_t k = 0; k < count; ++k) {
        own.places.push_back(represent[partner][k]);
        own.area_root.push_back(std::sqrt(areas[partner] / static_cast<double>(count)));
      }
    }
    if (clusters[c].parent >= 0) add_thinned(samples[clusters[c].parent], inherited, own);
    for (std::size_t k = 0; k < own.places.size(); ++k) {  // in turn, or an edge would show one of its faces only
      const auto around = triangles[tree.order()[own.places[k]]];
      own.triangles.push_back(around[k % around.size()]);
    }
    while (own.places.size() % kPanel != 0) {
      own.places.push_back(own.places.back());
      own.triangles.push_back(own.triangles.back());
      own.area_root.push_back(0);
    }
  }
  return samples;
}

template class PointKernel<Kelvin<double>>;

}  // namespace skinbem
