// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <omp.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <skinbem/solve/block_gmres.hpp>

#include "tolerances.hpp"

namespace skinbem {
namespace {

constexpr Index kRows = 60;

void identity(const VectorBlock& in, VectorBlock& out) { out = in; }

BlockOperator times(const Eigen::MatrixXd& A) {
  return [A](const VectorBlock& in, VectorBlock& out) { out = A * in; };
}

/// Of the second kind, not symmetric.
Eigen::MatrixXd second_kind(Index n, double disorder = 0.03) {
  std::srand(7);
  return 0.5 * Eigen::MatrixXd::Identity(n, n) + disorder * Eigen::MatrixXd::Random(n, n);
}

VectorBlock right_hand_sides(Index n, Index columns) {
  std::srand(8);
  return VectorBlock::Random(n, columns);
}

/// Largest |g - A y| / |g| over the columns that are not zero.
double true_residual(const Eigen::MatrixXd& A, const VectorBlock& Y, const VectorBlock& G) {
  double largest = 0;
  for (Index c = 0; c < G.cols(); ++c) {
    if (G.col(c).norm() > 0) largest = std::max(largest, (G.col(c) - A * Y.col(c)).norm() / G.col(c).norm());
  }
  return largest;
}

/// Solves to `requested` and expects it, and a summary that says the truth.
GmresSummary expect_solved(const Eigen::MatrixXd& A, const VectorBlock& G, double requested = 1e-10) {
  GmresSummary summary;
  const VectorBlock Y = block_gmres(times(A), identity, G, {requested}, summary);
  EXPECT_LE(true_residual(A, Y, G), requested);
  EXPECT_NEAR(summary.residual, true_residual(A, Y, G), tolerance::rounding_of_sums);
  return summary;
}

TEST(BlockGmres, IsExactOnceItsSpaceIsTheWholeSpace) {
  const Eigen::MatrixXd A = Eigen::MatrixXd::Random(kRows, kRows);  // clusters nowhere: no help from the spectrum
  for (const Index columns : {1, 4, 18, 60}) {
    const GmresSummary summary = expect_solved(A, right_hand_sides(kRows, columns), 1e-7);
    EXPECT_LE(summary.iterations, (kRows + columns - 1) / columns + 1) << columns;  // one for rounding
  }
}

TEST(BlockGmres, BlockTakesFewerStepsThanItsColumnsAlone) {
  const Eigen::MatrixXd A = second_kind(kRows);
  const VectorBlock G = right_hand_sides(kRows, 6);
  const int together = expect_solved(A, G).iterations;
  for (Index c = 0; c < G.cols(); ++c) EXPECT_LT(together, expect_solved(A, G.col(c)).iterations);
}

TEST(BlockGmres, ColumnsThatDependOnEachOtherDoNoHarm) {
  const Eigen::MatrixXd A = second_kind(kRows);
  VectorBlock G = right_hand_sides(kRows, 6);
  G.col(2) = G.col(0);
  G.col(4) = G.col(1) - 3 * G.col(3);
  G.col(5) = G.col(0) + 1e-9 * G.col(5);
  expect_solved(A, G);
}

TEST(BlockGmres, ZeroColumnHasTheSolutionZero) {
  const Eigen::MatrixXd A = second_kind(kRows);
  VectorBlock G = right_hand_sides(kRows, 3);
  G.col(1).setZero();
  GmresSummary summary;
  const VectorBlock Y = block_gmres(times(A), identity, G, {1e-10}, summary);
  EXPECT_TRUE((Y.col(1).array() == 0).all());
  EXPECT_LE(true_residual(A, Y, G), 1e-10);
}

TEST(BlockGmres, OfZeroesIsZeroWithoutAStep) {
  const Eigen::MatrixXd A = second_kind(kRows);
  GmresSummary summary;
  const VectorBlock Y = block_gmres(times(A), identity, VectorBlock::Zero(kRows, 3), {1e-10}, summary);
  EXPECT_TRUE((Y.array() == 0).all());
  EXPECT_EQ(summary.iterations, 0);
  EXPECT_EQ(summary.residual, 0);
}

TEST(BlockGmres, ColumnThatConvergesAtOnceLeavesTheOthersAlone) {
  Eigen::MatrixXd A = second_kind(kRows);
  A.col(0) = 0.7 * Eigen::VectorXd::Unit(kRows, 0);  // an eigenvector
  VectorBlock G = right_hand_sides(kRows, 3);
  G.col(1) = Eigen::VectorXd::Unit(kRows, 0);
  expect_solved(A, G);
  EXPECT_EQ(expect_solved(A, G.col(1)).iterations, 1);
}

TEST(BlockGmres, ColumnsOfAnySizeAreEqual) {
  const Eigen::MatrixXd A = second_kind(kRows);
  VectorBlock G = right_hand_sides(kRows, 3);
  G.col(1) *= 1e-30;
  G.col(2) *= 1e30;
  expect_solved(A, G);
}

TEST(BlockGmres, ReportsThatItDidNotConverge) {
  Eigen::MatrixXd A = second_kind(kRows);
  GmresSummary summary;
  const VectorBlock G = right_hand_sides(kRows, 2);
  const VectorBlock Y = block_gmres(times(A), identity, G, {1e-10, 3}, summary);
  EXPECT_EQ(summary.iterations, 3);
  EXPECT_GT(summary.residual, 1e-10);
  EXPECT_NEAR(summary.residual, true_residual(A, Y, G), tolerance::rounding_of_sums);

  A.row(5) = A.row(6);  // no solution
  block_gmres(times(A), identity, G, {1e-10}, summary);
  EXPECT_GT(summary.residual, 1e-3);
}

TEST(BlockGmres, GoesOnFromTheTrueResidualOfARoundingOperator) {
  const Eigen::MatrixXd A = second_kind(kRows);
  const Eigen::MatrixXf rounded = A.cast<float>();
  const BlockOperator single = [&](const VectorBlock& in, VectorBlock& out) {
    out = (rounded * in.cast<float>()).cast<double>();
  };
  GmresSummary summary;
  const VectorBlock G = right_hand_sides(kRows, 4);
  const VectorBlock Y = block_gmres(single, identity, G, {3e-6}, summary);
  EXPECT_LE(summary.residual, 3e-6);
  EXPECT_NEAR(summary.residual, true_residual(A, Y, G), tolerance::compressed_f32);
}

TEST(BlockGmres, PreconditionerChangesTheStepsNotTheSolution) {
  const Eigen::MatrixXd A = second_kind(kRows, 0.08);
  const VectorBlock G = right_hand_sides(kRows, 2);
  const Eigen::MatrixXd nearly = (A + 0.001 * Eigen::MatrixXd::Random(kRows, kRows)).inverse();
  GmresSummary without, with;
  const VectorBlock Y = block_gmres(times(A), identity, G, {1e-11}, without);
  const VectorBlock Z = block_gmres(times(A), times(nearly), G, {1e-11}, with);
  EXPECT_LT(2 * with.iterations, without.iterations);
  EXPECT_LE((Y - Z).norm(), 1e-8 * Y.norm());  // condition
}

TEST(BlockGmres, ProductsOfLongBlocksHaveTheSameBitsForAnyNumberOfThreads) {
  const VectorBlock V = right_hand_sides(9001, 7), W = 2 * V.leftCols(5) + VectorBlock::Ones(9001, 5);
  const RowMajorMatrix S = RowMajorMatrix::Random(7, 5);
  const int threads = omp_get_max_threads();
  Eigen::MatrixXd products[2];
  VectorBlock sums[2] = {W, W};
  for (int k = 0; k < 2; ++k) {
    omp_set_num_threads(k + 1);
    products[k] = inner_products(V, W);
    add_product(V, S, sums[k]);
  }
  omp_set_num_threads(threads);
  EXPECT_EQ(products[0], products[1]);
  EXPECT_EQ(sums[0], sums[1]);
  EXPECT_LE((products[0] - V.transpose() * W).norm(), tolerance::rounding_of_sums * products[0].norm());
  EXPECT_LE((sums[0] - W - V * S).norm(), tolerance::rounding_of_sums * sums[0].norm());
}

TEST(BlockGmres, ProgressCanCancelIt) {
  GmresSummary summary;
  const auto stop = [](std::string_view, double) { return false; };
  EXPECT_THROW(block_gmres(times(second_kind(kRows)), identity, right_hand_sides(kRows, 2), {1e-10}, summary, stop),
               Error);
}

}  // namespace
}  // namespace skinbem
