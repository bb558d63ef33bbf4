// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/mesh/triangle_mesh.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <numbers>

#include "meshes.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using namespace testing_support;

TEST(TriangleMesh, VolumeIsExactOnPolyhedra) {
  EXPECT_NEAR(volume(tetrahedron()), 1.0 / 6, tolerance::rounding);
  EXPECT_NEAR(volume(cube(3)), 1, tolerance::rounding);
  EXPECT_NEAR(volume(thin_slab(5, 0.02)), 0.02, tolerance::rounding);
  EXPECT_NEAR(volume(needle_box()), 2.5, tolerance::rounding);
  EXPECT_NEAR(volume(l_shape(2)), 0.375, tolerance::rounding);
  EXPECT_NEAR(volume(square_ring()), 8, 8 * tolerance::rounding);
}

TEST(TriangleMesh, VolumeChangesSignWithOrientationAndSubtractsCavities) {
  EXPECT_DOUBLE_EQ(volume(reversed(cube())), -volume(cube()));
  EXPECT_NEAR(volume(hollow_sphere(2)), volume(icosphere(2)) * (1 - 0.125), tolerance::rounding_of_sums);
}

TEST(TriangleMesh, VolumeDoesNotDependOnThePlace) {
  EXPECT_NEAR(volume(moved(cube(2), {1000, -3000, 500})), 1, tolerance::rounding_far_away);
}

TEST(TriangleMesh, VolumeOfSpheresAndToriConvergesWithTheSquareOfTheEdge) {
  const double sphere = 4 * std::numbers::pi / 3;
  const double ratio = (sphere - volume(icosphere(2))) / (sphere - volume(icosphere(3)));
  EXPECT_GT(ratio, 3.8);
  EXPECT_LT(ratio, 4.1);
  const double ring = 2 * std::numbers::pi * std::numbers::pi * 0.16;
  const double ring_ratio = (ring - volume(torus(1, 0.4, 32, 16))) / (ring - volume(torus(1, 0.4, 64, 32)));
  EXPECT_GT(ring_ratio, 3.8);
  EXPECT_LT(ring_ratio, 4.1);
}

TEST(TriangleMesh, AreaVectorIsTwiceTheAreaAlongTheOutwardNormal) {
  const TriangleMesh mesh = cube();
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    const Vec3 centre = (mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2)) / 3;
    EXPECT_DOUBLE_EQ(area_vector(mesh, t).norm(), 1);
    EXPECT_GT(area_vector(mesh, t).dot(centre - Vec3::Constant(0.5)), 0.4);
  }
}

TEST(TriangleMesh, AreaVectorsOfAClosedSurfaceSumToZero) {
  for (const TriangleMesh& mesh : {icosphere(2), torus(), hollow_sphere(1), l_shape(2)}) {
    Vec3 sum = Vec3::Zero();
    for (Index t = 0; t < mesh.triangle_count(); ++t) sum += area_vector(mesh, t);
    EXPECT_LT(sum.norm(), tolerance::rounding_of_sums);
  }
}

TEST(TriangleMesh, VertexAreasSumToTheSurface) {
  EXPECT_NEAR(vertex_areas(cube(4)).sum(), 6, 6 * tolerance::rounding);
  EXPECT_NEAR(vertex_areas(tetrahedron())(0), 0.5, tolerance::rounding);
}

TEST(TriangleMesh, DiagonalIsThatOfTheBoundingBox) {
  EXPECT_DOUBLE_EQ(diagonal(cube()), std::sqrt(3.0));
  EXPECT_DOUBLE_EQ(diagonal(TriangleMesh{}), 0);
}

TEST(TriangleMesh, CountsOfTheTestBodiesAreThoseOfTheirGenus) {
  const auto euler = [](const TriangleMesh& mesh) { return mesh.vertex_count() - mesh.triangle_count() / 2; };
  for (const TriangleMesh& mesh : {tetrahedron(), cube(3), icosphere(2), l_shape(2), thin_slab(4)}) {
    EXPECT_EQ(euler(mesh), 2);
  }
  EXPECT_EQ(euler(torus()), 0);
  EXPECT_EQ(euler(square_ring()), 0);
  EXPECT_EQ(euler(hollow_sphere(1)), 4);
  EXPECT_EQ(icosphere(3).vertex_count(), 642);
}

}  // namespace
}  // namespace skinbem
