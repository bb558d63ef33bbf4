// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Clusters of vertices that are close in space: a binary tree.
#pragma once

#include <Eigen/Geometry>
#include <array>
#include <cstdint>
#include <vector>

#include <skinbem/base/types.hpp>
#include <skinbem/kernels/panel.hpp>
#include <skinbem/mesh/triangle_mesh.hpp>

namespace skinbem {

/// Vertices order[begin] to order[end - 1].
struct Cluster {
  std::int32_t begin, end;
  std::int32_t parent = -1;
  std::array<std::int32_t, 2> children = {-1, -1};
  Eigen::AlignedBox3d points;   ///< of the vertices
  Eigen::AlignedBox3d support;  ///< of the triangles around them, where their hat functions live

  bool is_leaf() const { return children[0] < 0; }
  std::int32_t size() const { return end - begin; }
};

/// Row of a component of the vertex at a place in the tree's order of vectors: by panel of kPanel vertices, component,
/// vertex. The same within a leaf, with places counted from its first.
inline Index tree_row(Index place, int component, int components) {
  return (place / Index(kPanel) * components + component) * Index(kPanel) + place % Index(kPanel);
}

/// Halves the vertices across the longest side of their box until about `leaf_size` are left. Every leaf but the last
/// has exactly leaf_size vertices, so that panels of rows never straddle two. The last one has up to `largest_leaf`: a
/// leaf of very few vertices would be seen as very few dipoles from afar.
class ClusterTree {
 public:
  static constexpr std::int32_t leaf_size = 32;
  static constexpr std::int32_t largest_leaf = leaf_size + std::int32_t(kPanel);

  explicit ClusterTree(const TriangleMesh& mesh);

  /// Parents stand before their children, level by level; the root is first.
  const std::vector<Cluster>& clusters() const { return clusters_; }
  /// In the order of the vertices.
  const std::vector<std::int32_t>& leaves() const { return leaves_; }
  /// Clusters levels[l] to levels[l + 1] - 1 are on level l.
  const std::vector<std::int32_t>& levels() const { return levels_; }
  /// The vertex at each place.
  const std::vector<std::int32_t>& order() const { return order_; }

 private:
  void split(std::int32_t cluster, const Points& vertices);
  void add_boxes(const TriangleMesh& mesh);

  std::vector<Cluster> clusters_;
  std::vector<std::int32_t> leaves_;
  std::vector<std::int32_t> levels_;
  std::vector<std::int32_t> order_;
};

/// Which pairs of clusters are far from each other, so that their block has a low rank, and which pairs of leaves are
/// not. Every pair of vertices is in exactly one of them.
struct BlockPartition {
  std::vector<std::vector<std::int32_t>> far;   ///< by cluster: partners, symmetric
  std::vector<std::vector<std::int32_t>> near;  ///< by cluster (leaves only): leaves, symmetric, itself included

  /// Far where the larger diameter is at most `eta` times the distance, hat functions' supports included; nothing is
  /// far where eta is zero.
  BlockPartition(const ClusterTree& tree, double eta);

  /// Whether the cluster or one of its ancestors has far partners.
  std::vector<bool> has_far_field(const ClusterTree& tree) const;
};

}  // namespace skinbem
