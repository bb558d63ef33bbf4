// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/response/nearest_point.hpp>

#include <gtest/gtest.h>

#include "meshes.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

TEST(NearestPoint, OnACubeIsThePointClampedToIt) {
  const TriangleMesh cube = testing_support::cube(2);
  const Vec3 low = cube.vertices.colwise().minCoeff();
  const Vec3 high = cube.vertices.colwise().maxCoeff();
  std::srand(5);
  for (int i = 0; i < 200; ++i) {
    const Vec3 point = 3 * Vec3::Random();
    const Vec3 clamped = point.cwiseMax(low).cwiseMin(high);
    if (clamped == point) continue;  // inside
    const SurfacePoint nearest = nearest_point(cube, point);
    EXPECT_LE((nearest.position - clamped).norm(), 10 * tolerance::rounding);
    EXPECT_GE(nearest.barycentric.minCoeff(), 0);
    EXPECT_NEAR(nearest.barycentric.sum(), 1, tolerance::rounding);
    Vec3 position = Vec3::Zero();
    for (int c = 0; c < 3; ++c) position += nearest.barycentric(c) * cube.corner(nearest.triangle, c);
    EXPECT_LE((position - nearest.position).norm(), tolerance::rounding);
  }
}

TEST(NearestPoint, CopesWithADegenerateTriangle) {
  const TriangleMesh needle = testing_support::make_mesh({{0, 0, 0}, {1, 0, 0}, {2, 0, 0}}, {{0, 1, 2}});
  EXPECT_LE((nearest_point(needle, {1.5, 1, 0}).position - Vec3(1.5, 0, 0)).norm(), tolerance::rounding);
}

}  // namespace
}  // namespace skinbem
