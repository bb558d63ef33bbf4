// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/hmatrix/cluster_tree.hpp>

#include <algorithm>
#include <numeric>

namespace skinbem {

ClusterTree::ClusterTree(const TriangleMesh& mesh) : order_(static_cast<std::size_t>(mesh.vertex_count())) {
  std::iota(order_.begin(), order_.end(), 0);
  clusters_.push_back({0, static_cast<std::int32_t>(mesh.vertex_count()), -1, {-1, -1}, {}, {}});
  levels_ = {0};
  for (std::size_t first = 0; first < clusters_.size();) {  // level by level
    const std::size_t last = clusters_.size();
    levels_.push_back(static_cast<std::int32_t>(last));
    for (; first < last; ++first) split(static_cast<std::int32_t>(first), mesh.vertices);
  }
  for (std::int32_t c = 0; c < static_cast<std::int32_t>(clusters_.size()); ++c) {
    if (clusters_[c].is_leaf()) leaves_.push_back(c);
  }
  std::sort(leaves_.begin(), leaves_.end(), [&](auto a, auto b) { return clusters_[a].begin < clusters_[b].begin; });
  add_boxes(mesh);
}

void ClusterTree::split(std::int32_t cluster, const Points& vertices) {
  const std::int32_t begin = clusters_[cluster].begin, end = clusters_[cluster].end;
  Eigen::AlignedBox3d box;
  for (std::int32_t k = begin; k < end; ++k) box.extend(vertices.row(order_[k]).transpose());
  clusters_[cluster].points = box;
  if (end - begin <= largest_leaf) return;
  Index axis = 0;
  box.sizes().maxCoeff(&axis);
  const std::int32_t leaves = (end - begin - 1 + 2 * leaf_size - largest_leaf) / leaf_size;
  const std::int32_t middle = begin + leaf_size * (leaves / 2);
  std::nth_element(order_.begin() + begin, order_.begin() + middle, order_.begin() + end,
                   [&](auto a, auto b) { return std::pair(vertices(a, axis), a) < std::pair(vertices(b, axis), b); });
  for (int half = 0; half < 2; ++half) {
    clusters_[cluster].children[half] = static_cast<std::int32_t>(clusters_.size());
    clusters_.push_back({half == 0 ? begin : middle, half == 0 ? middle : end, cluster, {-1, -1}, {}, {}});
  }
}

void ClusterTree::add_boxes(const TriangleMesh& mesh) {
  std::vector<Eigen::AlignedBox3d> support(order_.size());
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    Eigen::AlignedBox3d box;
    for (int c = 0; c < 3; ++c) box.extend(mesh.corner(t, c));
    for (int c = 0; c < 3; ++c) support[mesh.triangles(t, c)].extend(box);
  }
  for (Cluster& cluster : clusters_) {
    for (std::int32_t k = cluster.begin; k < cluster.end; ++k) cluster.support.extend(support[order_[k]]);
  }
}

BlockPartition::BlockPartition(const ClusterTree& tree, double eta)
    : far(tree.clusters().size()), near(tree.clusters().size()) {
  const auto& clusters = tree.clusters();
  std::vector<std::array<std::int32_t, 2>> open = {{0, 0}};
  while (!open.empty()) {
    const auto [a, b] = open.back();
    open.pop_back();
    const Cluster &row = clusters[a], &column = clusters[b];
    const double distance =
        std::min(row.points.exteriorDistance(column.support), row.support.exteriorDistance(column.points));
    if (std::max(row.points.diagonal().norm(), column.points.diagonal().norm()) < eta * distance) {
      far[a].push_back(b);
    } else if (row.is_leaf() && column.is_leaf()) {
      near[a].push_back(b);
    } else {
      const bool split_row = !row.is_leaf() && (column.is_leaf() || row.size() >= column.size());
      const bool split_column = !column.is_leaf() && (row.is_leaf() || column.size() >= row.size());
      for (const std::int32_t i : split_row ? row.children : std::array{a, -1}) {
        for (const std::int32_t j : split_column ? column.children : std::array{b, -1}) {
          if (i >= 0 && j >= 0) open.push_back({i, j});
        }
      }
    }
  }
  for (auto* lists : {&far, &near}) {
    for (auto& list : *lists) std::sort(list.begin(), list.end());
  }
}

std::vector<bool> BlockPartition::has_far_field(const ClusterTree& tree) const {
  std::vector<bool> has(far.size());
  for (std::size_t c = 0; c < far.size(); ++c) {
    const std::int32_t parent = tree.clusters()[c].parent;
    has[c] = !far[c].empty() || (parent >= 0 && has[parent]);
  }
  return has;
}

}  // namespace skinbem
