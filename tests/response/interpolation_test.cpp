// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/response/interpolation.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>

#include "meshes.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using testing_support::icosphere;
using Field = std::function<Vec3(const Vec3&)>;

#ifdef SKINBEM_WITH_CHOLMOD

/// A column: the field at the vertices, node-major.
Eigen::VectorXd sampled(const Points& vertices, const Field& field) {
  Eigen::VectorXd result(3 * vertices.rows());
  for (Index i = 0; i < vertices.rows(); ++i) result.segment<3>(3 * i) = field(vertices.row(i));
  return result;
}

double largest_error(const TriangleMesh& coarse, const TriangleMesh& fine, const Field& field) {
  const SkinInterpolation interpolation(coarse.vertices, fine);
  const Eigen::VectorXd expected = sampled(fine.vertices, field);
  const Eigen::VectorXd found = interpolation.apply(sampled(coarse.vertices, field));
  return (found - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
}

struct Pair {
  TriangleMesh coarse;
  TriangleMesh fine;
};

/// A coarse and a fine skin: vertices shared, vertices off the fine skin, sharp edges, a hole through the body, a body
/// far from the origin.
std::vector<Pair> pairs() {
  using namespace testing_support;
  return {{icosphere(1), icosphere(4)},
          {icosphere(2, 0.98), icosphere(4)},
          {cube(3), cube(10)},
          {torus(1, 0.4, 12, 6), torus(1, 0.4, 48, 24)},
          {moved(slender_ellipsoid(2), {500, -200, 800}), moved(slender_ellipsoid(4), {500, -200, 800})}};
}

TEST(Interpolation, ReproducesAffineFields) {
  Mat3 gradient;
  gradient << 1, 0.2, -0.3, 0.4, -0.5, 0.6, 0.1, 0.8, 0.9;
  const Vec3 constant(1, 2, 3);
  for (const Pair& pair : pairs()) {
    EXPECT_LE(largest_error(pair.coarse, pair.fine, [&](const Vec3&) { return constant; }), tolerance::affine);
    EXPECT_LE(largest_error(pair.coarse, pair.fine, [&](const Vec3& x) { return Vec3(constant + gradient * x); }),
              tolerance::affine);
  }
}

TEST(Interpolation, MeetsTheCoarseVertices) {
  const TriangleMesh coarse = icosphere(2);
  const TriangleMesh fine = icosphere(4);  // whose first vertices are those of `coarse`
  std::srand(3);
  const Eigen::VectorXd values = Eigen::VectorXd::Random(3 * coarse.vertex_count());
  const Eigen::VectorXd found = SkinInterpolation(coarse.vertices, fine).apply(values);
  EXPECT_LE((found.head(values.size()) - values).cwiseAbs().maxCoeff(), tolerance::interpolation_tie);
}

TEST(Interpolation, ErrorOfASmoothFieldFallsFasterThanTheSquareOfTheCoarseEdge) {
  const Field twist = [](const Vec3& x) {
    return Vec3(std::cos(x.z()) * x.x() - std::sin(x.z()) * x.y(), std::sin(x.z()) * x.x() + std::cos(x.z()) * x.y(),
                std::sin(2 * x.x()));
  };
  const TriangleMesh fine = icosphere(5);
  double before = largest_error(icosphere(1), fine, twist);
  EXPECT_LE(before, 0.1);
  for (const int level : {2, 3}) {
    const double error = largest_error(icosphere(level), fine, twist);
    EXPECT_LE(error, before / 4.5) << level;
    before = error;
  }
}

TEST(Interpolation, HardlyOvershootsABump) {
  const TriangleMesh coarse = icosphere(2);
  Eigen::VectorXd bump = Eigen::VectorXd::Zero(3 * coarse.vertex_count());
  bump(60) = 1;
  const Eigen::VectorXd found = SkinInterpolation(coarse.vertices, icosphere(4)).apply(bump);
  EXPECT_LE(found.maxCoeff(), 1.02);
  EXPECT_GE(found.minCoeff(), -0.12);
}

TEST(Interpolation, GoesAlongTheSkinNotThroughTheGap) {
  // Two bodies 0.05 apart, one at rest, one moved: nothing of the motion crosses the gap.
  using testing_support::icosphere;
  const auto two = [](int level) {
    return testing_support::joined(icosphere(level), testing_support::moved(icosphere(level), {2.05, 0, 0}));
  };
  const TriangleMesh coarse = two(2);
  const TriangleMesh fine = two(3);
  Eigen::VectorXd displacement = Eigen::VectorXd::Zero(3 * coarse.vertex_count());
  displacement.tail(displacement.size() / 2).setOnes();
  const Eigen::VectorXd found = SkinInterpolation(coarse.vertices, fine).apply(displacement);
  EXPECT_LE(found.head(found.size() / 2).cwiseAbs().maxCoeff(), tolerance::affine);
  EXPECT_LE((found.tail(found.size() / 2).array() - 1).abs().maxCoeff(), tolerance::affine);
}

TEST(Interpolation, ColumnsAreIndependentHoweverMany) {
  const TriangleMesh coarse = icosphere(1);
  const SkinInterpolation interpolation(coarse.vertices, icosphere(2));
  const Eigen::MatrixXd values = Eigen::MatrixXd::Random(3 * coarse.vertex_count(), 40);
  const Eigen::MatrixXd all = interpolation.apply(values);
  for (const Index column : {0, 15, 16, 39}) {
    EXPECT_LE((interpolation.apply(values.col(column)) - all.col(column)).cwiseAbs().maxCoeff(), tolerance::affine);
  }
}

ErrorCode code_of(const std::function<void()>& call) {
  try {
    call();
  } catch (const Error& error) {
    return error.code();
  }
  return ErrorCode{0};
}

TEST(Interpolation, RefusesSkinsThatDoNotBelongTogether) {
  const TriangleMesh fine = icosphere(2);
  const Points coarse = icosphere(1).vertices;
  EXPECT_EQ(code_of([&] { SkinInterpolation(coarse * 1.3, fine); }), ErrorCode::bad_input);
  EXPECT_EQ(code_of([&] { SkinInterpolation(coarse * std::nan(""), fine); }), ErrorCode::bad_input);
  EXPECT_EQ(code_of([&] { SkinInterpolation(Points(), fine); }), ErrorCode::usage);
  EXPECT_EQ(code_of([&] { SkinInterpolation(coarse, TriangleMesh()); }), ErrorCode::usage);
  EXPECT_EQ(code_of([&] { SkinInterpolation(coarse, fine).apply(Eigen::MatrixXd::Zero(3, 1)); }), ErrorCode::usage);
}

TEST(Interpolation, RefusesCoarseVerticesThatLeaveTheFineSkinOpen) {
  const TriangleMesh fine = icosphere(2);
  Points equator(0, 3);
  for (Index i = 0; i < fine.vertex_count(); ++i) {
    if (std::abs(fine.vertices(i, 2)) > 1e-9) continue;
    equator.conservativeResize(equator.rows() + 1, 3);
    equator.row(equator.rows() - 1) = fine.vertices.row(i);
  }
  ASSERT_GE(equator.rows(), 4);
  EXPECT_EQ(code_of([&] { SkinInterpolation(equator, fine); }), ErrorCode::numerical);
  const TriangleMesh two = testing_support::joined(fine, testing_support::moved(fine, {3, 0, 0}));
  EXPECT_EQ(code_of([&] { SkinInterpolation(fine.vertices, two); }), ErrorCode::numerical);
}

#else

TEST(Interpolation, SaysThatItIsNotBuiltIn) {
  EXPECT_THROW(SkinInterpolation(icosphere(1).vertices, icosphere(2)), Error);
}

#endif

}  // namespace
}  // namespace skinbem
