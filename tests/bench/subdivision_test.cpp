// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <skinbem/mesh/mesh_io.hpp>
#include <skinbem/mesh/validate.hpp>

#include "meshes.hpp"
#include "subdivision.hpp"
#include "tolerances.hpp"

namespace skinbem::bench {
namespace {

using namespace testing_support;

TEST(SmoothRefinements, KeepTheVerticesOfEveryCoarserMesh) {
  const auto meshes = smooth_refinements(slender_ellipsoid(1), 3);
  ASSERT_EQ(meshes.size(), 4u);
  EXPECT_EQ(meshes[0].vertices, slender_ellipsoid(1).vertices);
  for (std::size_t i = 1; i < meshes.size(); ++i) {
    const Points& coarse = meshes[i - 1].vertices;
    EXPECT_EQ(meshes[i].vertices.topRows(coarse.rows()), coarse);
    EXPECT_EQ(meshes[i].triangle_count(), 4 * meshes[i - 1].triangle_count());
  }
}

TEST(SmoothRefinements, OfASphereStayNearIt) {
  const auto meshes = smooth_refinements(icosphere(2), 3);
  EXPECT_LE((meshes.back().vertices.rowwise().norm().array() - 1).abs().maxCoeff(), tolerance::loop_sphere);
}

TEST(SmoothRefinements, BoundTheBodyOfTheLowerLimb) {
  const TriangleMesh skin = read_mesh(SKINBEM_TEST_SOURCE_DIR "/data/lower_limb/skin.obj");
  for (const TriangleMesh& mesh : smooth_refinements(skin, 2)) {
    EXPECT_TRUE(inspect(mesh).defects.empty()) << mesh.vertex_count();
  }
}

}  // namespace
}  // namespace skinbem::bench
