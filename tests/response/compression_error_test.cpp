// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/response/compression_error.hpp>

#include <gtest/gtest.h>

#include <numeric>
#include <set>

#include <skinbem/solve/rigid_modes.hpp>

#include "meshes.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using namespace testing_support;

TEST(DrawByWeight, GivesDifferentNumbersAndTheSameEveryTime) {
  std::vector<double> weights(1000);
  std::iota(weights.begin(), weights.end(), 1.0);
  const std::vector<std::int32_t> drawn = draw_by_weight(weights, 16);
  EXPECT_EQ(drawn.size(), 16u);
  EXPECT_EQ(std::set(drawn.begin(), drawn.end()).size(), 16u);
  EXPECT_EQ(drawn, draw_by_weight(weights, 16));
  weights.front() = 1e6;
  EXPECT_EQ(draw_by_weight(weights, 16).front(), 0);
}

TEST(DrawByWeight, FollowsTheWeights) {
  std::vector<double> weights(1000, 1.0);
  std::fill_n(weights.begin(), 100, 9.0);  // half of the sum
  const std::vector<std::int32_t> drawn = draw_by_weight(weights, 100);
  const auto heavy = std::count_if(drawn.begin(), drawn.end(), [](std::int32_t k) { return k < 100; });
  EXPECT_GT(heavy, 30);
  EXPECT_LT(heavy, 60);
}

TEST(DrawByWeight, TakesAllThatWeighAnything) {
  EXPECT_EQ(draw_by_weight({1, 1, 1}, 16).size(), 3u);
  EXPECT_EQ(draw_by_weight({0, 1, 0, 2}, 16).size(), 2u);
  EXPECT_TRUE(draw_by_weight({0, 0}, 16).empty());
}

/// Defects of one column: the same at all vertices but one.
Eigen::MatrixXd defects_with(double outlier) {
  Eigen::MatrixXd defects = Eigen::MatrixXd::Constant(48, 2, 0.5);
  defects.col(1).segment<3>(9).setConstant(outlier);
  return defects;
}

TEST(CompressionDefects, SizeIsARootMeanSquareThatNoVertexRules) {
  EXPECT_NEAR(CompressionDefects::size(defects_with(0.5)), 0.5, tolerance::rounding);
  EXPECT_NEAR(CompressionDefects::size(defects_with(1)), 0.5 * std::sqrt(19.0 / 16), tolerance::rounding);
  EXPECT_NEAR(CompressionDefects::size(defects_with(1.5)), 0.5 * std::sqrt(24.0 / 16), tolerance::rounding);
  EXPECT_NEAR(CompressionDefects::size(defects_with(1e6)), 0.5 * std::sqrt(24.0 / 16), tolerance::rounding);
}

TEST(CompressionDefects, WithoutMotionThereAreNone) {
  const TriangleMesh mesh = cube(1);
  const Eigen::MatrixXd B = rigid_modes(mesh.vertices), none = Eigen::MatrixXd::Zero(B.rows(), 3);
  const CompressionDefects defects({mesh, {0.45, 1.0}, {1e-4}}, B, none);
  const Eigen::MatrixXd left = defects.of(none, B.transpose() * none, none);
  EXPECT_EQ(left.rows(), 0);
  EXPECT_EQ(CompressionDefects::size(left), 0);
}

struct Ellipsoid {
  TriangleMesh mesh = slender_ellipsoid(3);
  Collocation<Kelvin<double>> collocation{mesh, {0.45, 1.0}, {1e-8}};
  Eigen::MatrixXd B = rigid_modes(mesh.vertices);
  RowMajorMatrix H = collocation.double_layer_matrix();
};

/// In every three rows, what the equations of a vertex lack is what its own displacement lacks, alone.
TEST(CompressionDefects, AreWhatAVertexLacks) {
  const Ellipsoid body;
  const Eigen::MatrixXd Y = Eigen::MatrixXd::Random(body.B.rows(), 4), answers = Eigen::MatrixXd::Random(Y.rows(), 3);
  const Eigen::MatrixXd L = body.B.transpose() * Y, G = body.H * Y + body.B * L;
  const CompressionDefects defects(body.collocation, body.B, answers);
  EXPECT_EQ(defects.of(Y, L, G).rows(), 48);
  EXPECT_LE(CompressionDefects::size(defects.of(Y, L, G)), tolerance::invariance);

  Eigen::MatrixXd wrong = G;
  for (Index v = 0; v < body.mesh.vertex_count(); ++v) {
    wrong.middleRows<3>(3 * v) -= body.H.block<3, 3>(3 * v, 3 * v) * Eigen::MatrixXd::Constant(3, 4, 0.01);
  }
  EXPECT_LE((defects.of(Y, L, wrong).array() - 0.01).abs().maxCoeff(), tolerance::invariance);
}

/// Compression has its share in what is left; the iteration has the rest.
TEST(CompressionDefects, TellWhatCompressionHasOfThem) {
  const Ellipsoid body;
  const Eigen::MatrixXd V = Eigen::MatrixXd::Random(body.B.rows(), 4), answers = Eigen::MatrixXd::Random(V.rows(), 3);
  const CompressionDefects defects(body.collocation, body.B, answers);
  Eigen::MatrixXd HV = body.H * V;
  EXPECT_LE(CompressionDefects::size(defects.of_compression(V, HV)), tolerance::invariance);
  for (Index v = 0; v < body.mesh.vertex_count(); ++v) {
    HV.middleRows<3>(3 * v) -= body.H.block<3, 3>(3 * v, 3 * v) * Eigen::MatrixXd::Constant(3, 4, 0.01);
  }
  EXPECT_LE((defects.of_compression(V, HV).array() - 0.01).abs().maxCoeff(), tolerance::invariance);
}

/// The tip of a body that bends is looked at more often than its middle.
TEST(CompressionDefects, AreLookedForWhereTheBodyMoves) {
  const Ellipsoid body;
  Eigen::MatrixXd answers = Eigen::MatrixXd::Zero(body.B.rows(), 3);
  const std::vector<std::int32_t> tip = {5, 17, 40, 41, 42, 100, 101, 102, 200, 210, 220, 230, 240, 250, 260, 270};
  for (const std::int32_t v : tip) answers.middleRows<3>(3 * v).setIdentity();
  answers += body.B * Eigen::MatrixXd::Random(6, 3) * 100;  // seen as no motion
  Eigen::MatrixXd G = Eigen::MatrixXd::Zero(body.B.rows(), 3);
  for (const std::int32_t v : tip) G.middleRows<3>(3 * v).setIdentity();
  const CompressionDefects defects(body.collocation, body.B, answers);
  const Eigen::MatrixXd left = defects.of(Eigen::MatrixXd::Zero(body.B.rows(), 3), Eigen::MatrixXd::Zero(6, 3), G);
  Index seen = 0;
  for (Index k = 0; k < left.rows() / 3; ++k) seen += left.middleRows<3>(3 * k).norm() > 0;
  EXPECT_GE(seen, 8);  // of 16; without regard to the motion 0.4 on the average
}

}  // namespace
}  // namespace skinbem
