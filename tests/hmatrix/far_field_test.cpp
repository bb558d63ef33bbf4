// SPDX-License-Identifier: BSD-3-Clause
// What clusters see of their far fields.
#include <gtest/gtest.h>

#include <algorithm>
#include <set>
#include <skinbem/hmatrix/far_field.hpp>

#include "meshes.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using namespace testing_support;

struct Sampled {
  TriangleMesh mesh = needle_box(150);
  ClusterTree tree{mesh};
  BlockPartition partition{tree, 1};
  FarSampler sampler{mesh, tree, partition};
  std::int32_t count = std::int32_t(tree.clusters().size());

  /// Its own and its ancestors'.
  std::vector<std::int32_t> partners(std::int32_t cluster) const {
    std::vector<std::int32_t> result;
    for (std::int32_t c = cluster; c >= 0; c = tree.clusters()[c].parent) {
      result.insert(result.end(), partition.far[c].begin(), partition.far[c].end());
    }
    return result;
  }
  bool sees(std::int32_t cluster, std::int32_t place) const {
    const std::vector<std::int32_t> far = partners(cluster);
    return std::any_of(far.begin(), far.end(), [&](std::int32_t p) {
      return tree.clusters()[p].begin <= place && place < tree.clusters()[p].end;
    });
  }
};

TEST(FarSampler, ShowsVerticesOfTheFarFieldOnly) {
  const Sampled body;
  for (std::int32_t c = 0; c < body.count; ++c) {
    const FarSamples samples = body.sampler.samples(c, 64);
    EXPECT_EQ(samples.places.empty(), body.partners(c).empty());
    EXPECT_EQ(samples.places.size() % kPanel, 0u);
    EXPECT_EQ(samples.triangles.size(), samples.places.size());
    EXPECT_EQ(samples.area_root.size(), samples.places.size());
    for (std::size_t k = 0; k < samples.places.size(); ++k) {
      EXPECT_TRUE(body.sees(c, samples.places[k]));
      const auto corners = body.mesh.triangles.row(samples.triangles[k]);
      EXPECT_TRUE((corners.array() == body.tree.order()[samples.places[k]]).any());  // a triangle at the vertex
    }
  }
}

/// A sum over samples is an integral: of one, the area; exact for those spread out, on the mean for those at random.
TEST(FarSampler, StandsForTheArea) {
  const Sampled body;
  const Eigen::VectorXd areas = vertex_areas(body.mesh);
  double of_random = 0, whole = 0;
  for (const std::int32_t leaf : body.tree.leaves()) {
    double area = 0;
    for (const std::int32_t p : body.partners(leaf)) {
      const Cluster& far = body.tree.clusters()[p];
      for (std::int32_t k = far.begin; k < far.end; ++k) area += areas[body.tree.order()[k]];
    }
    const FarSamples samples = body.sampler.samples(leaf, 2000);  // more than there are: every partner has some
    const Eigen::Map<const Eigen::VectorXd> roots(samples.area_root.data(), Index(samples.area_root.size()));
    EXPECT_NEAR(roots.head(roots.size() - Index(kPanel)).squaredNorm(), area, tolerance::rounding_of_sums * area);
    of_random += roots.tail(Index(kPanel)).squaredNorm();
    whole += area;
  }
  EXPECT_NEAR(of_random, whole, tolerance::random_area * whole);
}

TEST(FarSampler, ChecksWithVerticesOfItsOwnAndTheSameEveryTime) {
  const Sampled body;
  const std::int32_t leaf = body.tree.leaves().front();
  const FarSamples few = body.sampler.samples(leaf, 64), same = body.sampler.samples(leaf, 64);
  EXPECT_EQ(few.places, same.places);
  EXPECT_EQ(few.triangles, same.triangles);
  const std::set<std::int32_t> spread(few.places.begin(), few.places.end() - Index(kPanel));
  const auto own = std::count_if(few.places.end() - Index(kPanel), few.places.end(),
                                 [&](std::int32_t place) { return spread.count(place) == 0; });
  EXPECT_GT(own, Index(kPanel) / 2);
}

}  // namespace
}  // namespace skinbem
