// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/hmatrix/far_field.hpp>

#include <algorithm>
#include <cmath>
#include <random>

#include <skinbem/kernels/kelvin_batch.hpp>

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

FarSampler::FarSampler(const TriangleMesh& mesh, const ClusterTree& tree, const BlockPartition& partition)
    : tree_(tree),
      partition_(partition),
      triangles_(triangles_around_vertices(mesh)),
      representatives_(representatives(mesh, tree)) {
  const Eigen::VectorXd area_of_vertex = vertex_areas(mesh);
  for (const Cluster& cluster : tree.clusters()) {
    double& area = areas_.emplace_back(0);
    for (std::int32_t k = cluster.begin; k < cluster.end; ++k) area += area_of_vertex[tree.order()[k]];
  }
}

/// Everything that is far from a cluster: its own partners and its ancestors'.
std::vector<FarSampler::Partner> FarSampler::partners_of(std::int32_t cluster) const {
  const auto& clusters = tree_.clusters();
  std::vector<Partner> partners;
  for (std::int32_t c = cluster; c >= 0; c = clusters[c].parent) {
    for (const std::int32_t far : partition_.far[c]) {
      const double distance2 = clusters[cluster].points.squaredExteriorDistance(clusters[far].points);
      partners.push_back({far, areas_[far] / distance2});
    }
  }
  return partners;
}

double FarSampler::solid_angle(const std::vector<Partner>& partners) {
  double angle = 0;
  for (const Partner& partner : partners) angle += partner.angle;
  return angle;
}

FarSamples FarSampler::samples(std::int32_t cluster, Index count) const {
  FarSamples result;
  const std::vector<Partner> partners = partners_of(cluster);
  if (partners.empty()) return result;
  add_spread_out(partners, count, result);
  add_at_random(partners, result);
  for (std::size_t k = 0; k < result.places.size(); ++k) {  // in turn, or an edge would show one of its faces only
    const auto around = triangles_[tree_.order()[result.places[k]]];
    result.triangles.push_back(around[k % around.size()]);
  }
  return result;
}

void FarSampler::add_spread_out(const std::vector<Partner>& partners, Index count, FarSamples& samples) const {
  const double angle = solid_angle(partners);
  double wanted = 0.5, area = 0;  // of samples, rounded; of the partners that they stand for
  std::size_t taken = 0;
  for (const Partner& partner : partners) {
    wanted += static_cast<double>(count) * partner.angle / angle;
    area += areas_[partner.cluster];
    if (static_cast<std::size_t>(wanted) == taken) continue;  // the next one's samples stand for it too
    const auto& spread = representatives_[partner.cluster];
    const std::size_t own = std::min(spread.size(), static_cast<std::size_t>(wanted) - taken);
    samples.places.insert(samples.places.end(), spread.begin(), spread.begin() + Index(own));
    samples.area_root.insert(samples.area_root.end(), own, std::sqrt(area / static_cast<double>(own)));
    taken = static_cast<std::size_t>(wanted);
    area = 0;
  }
  while (samples.places.size() % kPanel != 0) {
    samples.places.push_back(samples.places.back());
    samples.area_root.push_back(0);
  }
}

/// One in each of kPanel equal parts of the partners' solid angle.
void FarSampler::add_at_random(const std::vector<Partner>& partners, FarSamples& samples) const {
  std::minstd_rand random(static_cast<unsigned>(partners.front().cluster + 1));
  const double part = solid_angle(partners) / double(kPanel);
  std::size_t p = 0;
  double sum = partners[0].angle;
  for (std::size_t k = 0; k < kPanel; ++k) {
    const double at = (double(k) + double(random()) / double(random.max())) * part;
    while (sum < at && p + 1 < partners.size()) sum += partners[++p].angle;
    const Cluster& far = tree_.clusters()[partners[p].cluster];
    samples.places.push_back(far.begin + std::int32_t(random() % unsigned(far.size())));
    samples.area_root.push_back(std::sqrt(areas_[partners[p].cluster] * part / partners[p].angle));
  }
}

template class PointKernel<Kelvin<double>>;

}  // namespace skinbem
