// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <algorithm>
#include <numeric>
#include <skinbem/hmatrix/cluster_tree.hpp>
#include <skinbem/kernels/panel.hpp>

#include "meshes.hpp"

namespace skinbem {
namespace {

using namespace testing_support;

class ClusterTreeOf : public ::testing::TestWithParam<std::pair<const char*, TriangleMesh>> {
 protected:
  const TriangleMesh& mesh_ = GetParam().second;
  ClusterTree tree_{mesh_};
};

TEST_P(ClusterTreeOf, HasEveryVertexOnce) {
  std::vector<std::int32_t> sorted = tree_.order(), all(static_cast<std::size_t>(mesh_.vertex_count()));
  std::sort(sorted.begin(), sorted.end());
  std::iota(all.begin(), all.end(), 0);
  EXPECT_EQ(sorted, all);
}

TEST_P(ClusterTreeOf, LeavesCoverTheVerticesInWholePanels) {
  std::int32_t end = 0;
  for (const std::int32_t leaf : tree_.leaves()) {
    const Cluster& cluster = tree_.clusters()[leaf];
    EXPECT_EQ(cluster.begin, end);
    EXPECT_EQ(cluster.begin % std::int32_t(kPanel), 0);
    EXPECT_LE(cluster.size(), ClusterTree::largest_leaf);
    end = cluster.end;
  }
  EXPECT_EQ(end, mesh_.vertex_count());
}

TEST_P(ClusterTreeOf, HasNoLeafOfAFewVertices) {
  for (const std::int32_t leaf : tree_.leaves()) {
    EXPECT_GE(tree_.clusters()[leaf].size(), std::min<Index>(kPanel, mesh_.vertex_count()));
  }
}

TEST_P(ClusterTreeOf, ChildrenHalveTheirParentOnTheNextLevel) {
  const auto& clusters = tree_.clusters();
  EXPECT_EQ(tree_.levels().front(), 0);
  EXPECT_EQ(tree_.levels().back(), std::int32_t(clusters.size()));
  for (std::size_t level = 0; level + 1 < tree_.levels().size(); ++level) {
    for (std::int32_t c = tree_.levels()[level]; c < tree_.levels()[level + 1]; ++c) {
      if (clusters[c].is_leaf()) continue;
      const Cluster &first = clusters[clusters[c].children[0]], &second = clusters[clusters[c].children[1]];
      EXPECT_EQ(first.begin, clusters[c].begin);
      EXPECT_EQ(first.end, second.begin);
      EXPECT_EQ(second.end, clusters[c].end);
      for (const std::int32_t child : clusters[c].children) {
        EXPECT_EQ(clusters[child].parent, c);
        EXPECT_GE(child, tree_.levels()[level + 1]);
        EXPECT_LT(child, tree_.levels()[level + 2]);
      }
    }
  }
}

TEST_P(ClusterTreeOf, BoxesHoldTheVerticesAndTheTrianglesAroundThem) {
  std::vector<std::int32_t> place(tree_.order().size());
  for (std::size_t k = 0; k < place.size(); ++k) place[tree_.order()[k]] = std::int32_t(k);
  for (const Cluster& cluster : tree_.clusters()) {
    Eigen::AlignedBox3d points, support;
    for (Index t = 0; t < mesh_.triangle_count(); ++t) {
      for (int c = 0; c < 3; ++c) {
        const std::int32_t p = place[mesh_.triangles(t, c)];
        if (p < cluster.begin || p >= cluster.end) continue;
        points.extend(mesh_.corner(t, c));
        for (int other = 0; other < 3; ++other) support.extend(mesh_.corner(t, other));
      }
    }
    EXPECT_TRUE(cluster.points.isApprox(points, 0));
    EXPECT_TRUE(cluster.support.isApprox(support, 0));
  }
}

/// How many blocks hold each pair of places.
Eigen::MatrixXi blocks_of_pairs(const ClusterTree& tree, const std::vector<std::vector<std::int32_t>>& partners) {
  const Index n = Index(tree.order().size());
  Eigen::MatrixXi count = Eigen::MatrixXi::Zero(n, n);
  for (std::size_t a = 0; a < partners.size(); ++a) {
    const Cluster& row = tree.clusters()[a];
    for (const std::int32_t b : partners[a]) {
      const Cluster& column = tree.clusters()[b];
      count.block(row.begin, column.begin, row.size(), column.size()).array() += 1;
    }
  }
  return count;
}

TEST_P(ClusterTreeOf, PartitionHoldsEveryPairOnceAndIsSymmetric) {
  for (const double eta : {0.0, 0.7, 1.5, 3.0}) {
    const BlockPartition partition(tree_, eta);
    const Eigen::MatrixXi far = blocks_of_pairs(tree_, partition.far), near = blocks_of_pairs(tree_, partition.near);
    EXPECT_TRUE((far + near == Eigen::MatrixXi::Ones(far.rows(), far.cols()))) << eta;
    EXPECT_EQ(far, far.transpose()) << eta;
    EXPECT_EQ(far.sum() * (eta == 0), 0);
  }
}

TEST_P(ClusterTreeOf, FarPairsAreFarAndOnlyLeavesAreNear) {
  const double eta = 1.5;
  const BlockPartition partition(tree_, eta);
  const auto& clusters = tree_.clusters();
  for (std::size_t a = 0; a < clusters.size(); ++a) {
    for (const std::int32_t b : partition.far[a]) {
      const double distance = clusters[a].points.exteriorDistance(clusters[b].support);
      EXPECT_LE(clusters[a].points.diagonal().norm(), eta * distance);
      EXPECT_LE(clusters[b].points.diagonal().norm(), eta * distance);
    }
    EXPECT_EQ(partition.near[a].empty(), !clusters[a].is_leaf());
    if (clusters[a].is_leaf()) {
      EXPECT_EQ(std::count(partition.near[a].begin(), partition.near[a].end(), std::int32_t(a)), 1);
    }
    for (const std::int32_t b : partition.near[a]) EXPECT_TRUE(clusters[b].is_leaf());
  }
}

TEST_P(ClusterTreeOf, FarFieldIsInheritedByChildren) {
  const BlockPartition partition(tree_, 1.5);
  const std::vector<bool> has = partition.has_far_field(tree_);
  for (std::size_t c = 0; c < has.size(); ++c) {
    bool expected = false;
    for (std::int32_t a = std::int32_t(c); a >= 0; a = tree_.clusters()[a].parent)
      expected |= !partition.far[a].empty();
    EXPECT_EQ(has[c], expected) << c;
  }
}

INSTANTIATE_TEST_SUITE_P(Bodies, ClusterTreeOf,
                         ::testing::Values(std::pair{"tetrahedron", tetrahedron()}, std::pair{"sphere", icosphere(3)},
                                           std::pair{"one leaf", box({1, 1, 1}, {2, 2, 3})},
                                           std::pair{"two leaves", box({1, 1, 1}, {2, 4, 4})},
                                           std::pair{"cube", cube(9)}, std::pair{"slab", thin_slab(12)},
                                           std::pair{"needle", needle_box(100)}),
                         [](const auto& body) {
                           std::string name = body.param.first;
                           std::replace(name.begin(), name.end(), ' ', '_');
                           return name;
                         });

TEST(ClusterTree, VerticesAtOnePlaceEndInLeavesToo) {
  TriangleMesh mesh = soup(cube(4));  // six vertices at most places
  mesh.vertices.topRows(100).setZero();
  const ClusterTree tree(mesh);
  EXPECT_GE(Index(tree.leaves().size()) * ClusterTree::largest_leaf, mesh.vertex_count());
  EXPECT_EQ(tree.clusters().size(), 2 * tree.leaves().size() - 1);
}

}  // namespace
}  // namespace skinbem
