// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <skinbem/hmatrix/exact_rows.hpp>

#include "meshes.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using namespace testing_support;

/// The dense matrix's rows and these ones of the same vertices.
struct RowsOfASphere {
  Collocation<Kelvin<double>> collocation{icosphere(3), {0.45, 1.0}, {1e-11}};
  RowMajorMatrix H = collocation.double_layer_matrix();
};

TEST(ExactRows, AreRowsOfTheDenseMatrix) {
  const RowsOfASphere sphere;
  const ExactRows rows(sphere.collocation, {3, 600, 0, 17, 5, 200, 81});
  const Eigen::MatrixXd V = Eigen::MatrixXd::Random(sphere.H.cols(), 4);
  const Eigen::MatrixXd expected = rows.pick(sphere.H * V), found = rows.multiply(V);
  ASSERT_EQ(found.rows(), 21);
  EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), tolerance::invariance);
}

TEST(ExactRows, HaveTheirOwnBlocks) {
  const RowsOfASphere sphere;
  const ExactRows rows(sphere.collocation, {81, 4});
  EXPECT_LE((rows.own_block(0) - sphere.H.block<3, 3>(3 * 81, 3 * 81)).cwiseAbs().maxCoeff(), tolerance::invariance);
  EXPECT_LE((rows.own_block(1) - sphere.H.block<3, 3>(3 * 4, 3 * 4)).cwiseAbs().maxCoeff(), tolerance::invariance);
}

/// A needle, at whose tip slivers meet.
struct RowsOfANeedle {
  TriangleMesh mesh = spiked_sphere(3, 12);
  Collocation<Kelvin<double>> collocation{mesh, {0.45, 1.0}, {1e-3}};
  RowMajorMatrix H = collocation.double_layer_matrix();
  RowMajorMatrix exact = collocation.with_tolerance(1e-12).double_layer_matrix();

  Mat3 own_block(std::size_t v) const { return exact.block<3, 3>(3 * Index(v), 3 * Index(v)); }
  /// Of the tip's equations, solved for its own displacement.
  double error_at_the_tip(const Eigen::MatrixXd& rows) const {
    return (own_block(0).inverse() * (rows - exact.topRows<3>())).cwiseAbs().rowwise().sum().maxCoeff();
  }
};

TEST(CloseToSingular, IsTheTipOfANeedle) {
  const RowsOfANeedle needle;
  const auto own = [&](std::size_t v) { return needle.own_block(v); };
  EXPECT_EQ(close_to_singular(std::size_t(needle.mesh.vertex_count()), own), std::vector<std::size_t>{0});
  const Mat3 flat = Mat3::Identity() / 2, steep = Mat3::Identity() / 100, none = Mat3::Zero();
  const std::vector<Mat3> blocks = {flat, steep, flat, none};
  EXPECT_EQ(close_to_singular(4, [&](std::size_t k) { return blocks[k]; }), (std::vector<std::size_t>{3, 1}));
  EXPECT_EQ(close_to_singular(100, [&](std::size_t) { return steep; }).size(), 64u);
}

TEST(ExactRows, AreIntegratedCarefullyWhereAnErrorWouldBeMultiplied) {
  RowsOfANeedle needle;
  const double careless = needle.error_at_the_tip(needle.H.topRows<3>());
  const ExactRows rows(needle.collocation, {7, 0});
  EXPECT_LE(needle.error_at_the_tip(rows.rows().bottomRows<3>()), careless / 30);
  const RowMajorMatrix before = needle.H;
  integrate_carefully(needle.collocation, needle.H);
  EXPECT_EQ(needle.H.topRows<3>(), rows.rows().bottomRows<3>());
  EXPECT_EQ(needle.H.bottomRows(needle.H.rows() - 3), before.bottomRows(before.rows() - 3));
}

}  // namespace
}  // namespace skinbem
