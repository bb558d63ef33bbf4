// SPDX-License-Identifier: BSD-3-Clause
// What is recovered of a displacement's curvature: nothing where there is none, and all of it on a regular mesh.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <skinbem/operator/recovered_curvature.hpp>

#include "layer_sums.hpp"
#include "meshes.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using namespace testing_support;

class RecoveredCurvatureAt : public ::testing::TestWithParam<double> {};

TEST_P(RecoveredCurvatureAt, ConstantStrainHasNone) {
  Mat3 F;
  F << 1, 0.6, -0.3, 0.4, -2, 0.7, -0.1, 0.2, 0.3;
  F -= F.trace() / 3 * Mat3::Identity();  // any pressure goes with it where nu is 1/2
  const Mat3 stress = F + F.transpose();
  for (const TriangleMesh& mesh : {cube(3), tetrahedron(), square_ring(), torus(), needle_box(10), hollow_sphere(1)}) {
    const RecoveredCurvature curvature(mesh, GetParam());
    Points tractions(mesh.triangle_count(), 3);
    for (Index t = 0; t < mesh.triangle_count(); ++t) tractions.row(t) = (stress * unit_normal(mesh, t)).transpose();
    const Eigen::VectorXd u = at_vertices(mesh, [&](const Vec3& x) { return Vec3(F * x + Vec3(1, 2, 3)); });
    const Eigen::VectorXd s = curvature.of_displacements(Eigen::MatrixXd(u)) + curvature.of_tractions(tractions);
    EXPECT_LE(s.cwiseAbs().maxCoeff(), tolerance::rounding_of_sums * u.cwiseAbs().maxCoeff()) << mesh.vertex_count();
  }
}

INSTANTIATE_TEST_SUITE_P(Poisson, RecoveredCurvatureAt, ::testing::Values(-0.5, 0.0, 0.3, 0.45, 0.5));

TEST(RecoveredCurvature, IsExactWhereTrianglesLieAlikeAroundVertices) {
  const TriangleMesh mesh = thin_slab(8, 0.5, 4);
  const RecoveredCurvature curvature(mesh, 0.3);
  // u = (0, 0, x^2 + 3 x y): bows of -(dx^2 + 3 dx dy) / 4 along an edge (dx, dy)
  const Eigen::MatrixXd u = at_vertices(mesh, [](const Vec3& x) { return Vec3(0, 0, x[0] * x[0] + 3 * x[0] * x[1]); });
  const Eigen::MatrixXd s = curvature.of_displacements(u);
  const IndexLists around = triangles_around_vertices(mesh);
  int compared = 0;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const Vec3 x = mesh.vertices.row(v);
    if (x[2] < 0.5 || x.head<2>().minCoeff() < 0.2 || x.head<2>().maxCoeff() > 0.8) continue;  // top, far from its rim
    double bows = 0, area = 0;
    for (const std::int32_t t : around[v]) {
      const double a = area_vector(mesh, t).norm();
      for (int c = 0; c < 3; ++c) {
        const Vec3 d = mesh.corner(t, c) - x;
        bows += a * -(d[0] * d[0] + 3 * d[0] * d[1]) / 4 / 2;
      }
      area += a;
    }
    EXPECT_NEAR(s(3 * v + 2, 0), bows / area, tolerance::rounding);
    ++compared;
  }
  EXPECT_EQ(compared, 25);
}

TEST(RecoveredCurvature, OfTractionsHasTheUnitOfLength) {
  const TriangleMesh mesh = torus();
  const Points tractions = Points::Random(mesh.triangle_count(), 3);
  const Eigen::VectorXd s = RecoveredCurvature(mesh, 0.3).of_tractions(tractions);
  const Eigen::VectorXd larger = RecoveredCurvature(stretched(mesh, {1e3, 1e3, 1e3}), 0.3).of_tractions(tractions);
  EXPECT_LE((larger / 1e3 - s).cwiseAbs().maxCoeff(), tolerance::rounding_of_sums * s.cwiseAbs().maxCoeff());
}

TEST(RecoveredCurvature, OfATractionOnOneTriangleReachesItsNeighboursOnly) {
  const TriangleMesh mesh = thin_slab(8, 0.5, 4);
  const RecoveredCurvature curvature(mesh, 0.3);
  Points tractions = Points::Zero(mesh.triangle_count(), 3);
  tractions.row(0) << 1, 2, 3;
  const Points first = curvature.of_tractions(tractions).reshaped<Eigen::RowMajor>(mesh.vertex_count(), 3);
  const IndexLists neighbours = neighbours_of_vertices(mesh);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    bool near = false;
    for (int c = 0; c < 3; ++c) {
      const std::int32_t corner = mesh.triangles(0, c);
      near = near || v == corner || std::ranges::count(neighbours[corner], std::int32_t(v)) > 0;
    }
    if (near) continue;
    EXPECT_EQ(first.row(v).norm(), 0) << v;
  }
  EXPECT_GT(first.norm(), 0);
}

}  // namespace
}  // namespace skinbem
