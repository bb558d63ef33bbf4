// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/mesh/closest_point.hpp>

#include <gtest/gtest.h>

#include <random>

#include <skinbem/base/error.hpp>

#include "meshes.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using namespace testing_support;

std::vector<Vec3> random_points(int count, double reach) {
  std::mt19937 random(5);
  std::uniform_real_distribution<double> coordinate(-reach, reach);
  std::vector<Vec3> points;
  for (int i = 0; i < count; ++i) points.emplace_back(coordinate(random), coordinate(random), coordinate(random));
  return points;
}

TEST(ClosestPoint, OfATriangleIsRightInEveryRegion) {
  const Vec3 a(0, 0, 0), b(2, 0, 0), c(0, 2, 0);
  const auto closest = [&](const Vec3& p) { return closest_point_of_triangle(a, b, c, p).position; };
  EXPECT_LT((closest({0.5, 0.5, 3}) - Vec3(0.5, 0.5, 0)).norm(), tolerance::rounding);
  EXPECT_EQ(closest({-1, -1, 1}), a);
  EXPECT_EQ(closest({5, -1, 1}), b);
  EXPECT_EQ(closest({-1, 5, 1}), c);
  EXPECT_EQ(closest({1, -3, 1}), Vec3(1, 0, 0));
  EXPECT_EQ(closest({-3, 1, 1}), Vec3(0, 1, 0));
  EXPECT_EQ(closest({2, 2, 1}), Vec3(1, 1, 0));
  EXPECT_EQ(closest_point_of_triangle(a, b, Vec3(1, 0, 0), {1, 1, 0}).position, Vec3(1, 0, 0));
  EXPECT_EQ(closest_point_of_triangle(a, a, a, {1, 1, 0}).position, a);
}

TEST(ClosestPoint, OfAMeshIsThatOfItsNearestTriangle) {
  for (const TriangleMesh& mesh : {icosphere(2), l_shape(2), torus()}) {
    const SurfaceQuery query(mesh);
    for (const Vec3& p : random_points(200, 2)) {
      double nearest = 1e300;
      for (Index t = 0; t < mesh.triangle_count(); ++t) {
        nearest = std::min(
            nearest, closest_point_of_triangle(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2), p).distance);
      }
      const SurfacePoint found = query.closest(p);
      EXPECT_DOUBLE_EQ(found.distance, nearest);
      EXPECT_GE(found.barycentric.minCoeff(), 0);
      EXPECT_NEAR(found.barycentric.sum(), 1, tolerance::rounding);
      Vec3 position = Vec3::Zero();
      for (int c = 0; c < 3; ++c) position += found.barycentric(c) * mesh.corner(found.triangle, c);
      EXPECT_LT((position - found.position).norm(), tolerance::rounding);
    }
  }
}

TEST(ClosestPoint, OfAVertexIsTheVertex) {
  const TriangleMesh mesh = torus();
  const SurfaceQuery query(mesh);
  for (Index v = 0; v < mesh.vertex_count(); ++v)
    EXPECT_LT(query.closest(mesh.vertices.row(v)).distance, tolerance::rounding);
}

TEST(WindingNumber, IsOneInsideAndZeroOutsideAndInCavities) {
  const SurfaceQuery box(l_shape(3));
  for (const Vec3& p : random_points(500, 1.2)) {
    const bool in = p.minCoeff() > 0 && p.x() < 1 && p.y() < 1 && p.z() < 0.5 && (p.x() < 0.5 || p.y() < 0.5);
    EXPECT_EQ(box.inside(p), in);
    EXPECT_NEAR(box.winding_number(p), in ? 1 : 0, tolerance::winding_number);
  }
  const SurfaceQuery shell(hollow_sphere(3));
  EXPECT_NEAR(shell.winding_number({0, 0.1, 0}), 0, tolerance::winding_number);
  EXPECT_NEAR(shell.winding_number({0, 0.75, 0}), 1, tolerance::winding_number);
  EXPECT_NEAR(shell.winding_number({0, 1.1, 0}), 0, tolerance::winding_number);
  EXPECT_NEAR(SurfaceQuery(reversed(icosphere(1))).winding_number({0, 0, 0}), -1, tolerance::winding_number);
}

TEST(WindingNumber, DecidesCloseToTheSurface) {
  const TriangleMesh mesh = icosphere(3);
  const SurfaceQuery query(mesh);
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    const Vec3 centre = (mesh.corner(t, 0) + mesh.corner(t, 1) + mesh.corner(t, 2)) / 3;
    EXPECT_TRUE(query.inside(centre * (1 - 1e-6)));
    EXPECT_FALSE(query.inside(centre * (1 + 1e-6)));
  }
}

TEST(SurfaceQuery, RefusesAMeshWithoutTriangles) { EXPECT_THROW(SurfaceQuery{TriangleMesh{}}, Error); }

}  // namespace
}  // namespace skinbem
