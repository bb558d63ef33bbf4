// SPDX-License-Identifier: BSD-3-Clause
// Interpolative decomposition.
#include <gtest/gtest.h>

#include <Eigen/QR>
#include <set>
#include <skinbem/hmatrix/nested_basis.hpp>
#include <skinbem/hmatrix/tile_product.hpp>

#include "tolerances.hpp"

namespace skinbem {
namespace {

Eigen::MatrixXd orthonormal(Index rows, Index columns) {
  const Eigen::MatrixXd random = Eigen::MatrixXd::Random(rows, columns);
  return Eigen::HouseholderQR<Eigen::MatrixXd>(random).householderQ() * Eigen::MatrixXd::Identity(rows, columns);
}

/// Singular values 1, ratio, ratio^2, ... `rank` of them.
Eigen::MatrixXd matrix_with_decay(Index rows, Index columns, Index rank, double ratio) {
  std::srand(1);
  const Eigen::VectorXd sigma = Eigen::VectorXd::NullaryExpr(rank, [&](Index k) { return std::pow(ratio, double(k)); });
  return orthonormal(rows, rank) * sigma.asDiagonal() * orthonormal(columns, rank).transpose();
}

Eigen::MatrixXd chosen_columns(const Eigen::MatrixXd& A, const ColumnSelection& selection) {
  Eigen::MatrixXd result(A.rows(), Index(selection.columns.size()));
  for (Index k = 0; k < result.cols(); ++k) result.col(k) = A.col(selection.columns[k]);
  return result;
}

TEST(ColumnSelection, ReproducesAMatrixOfLowRankFromThatManyColumns) {
  for (const Index rank : {1, 5, 16, 23}) {
    const Eigen::MatrixXd A = matrix_with_decay(90, 40, rank, 0.9);
    const ColumnSelection selection = select_columns(A.transpose() * A, 1e-6);
    EXPECT_EQ(Index(selection.columns.size()), rank);  // no multiple of kTileStep: there are no more
    EXPECT_EQ(std::set(selection.columns.begin(), selection.columns.end()).size(), selection.columns.size());
    EXPECT_LE((A - chosen_columns(A, selection) * selection.weights.transpose()).norm(),
              tolerance::normal_equations * A.norm());
  }
}

TEST(ColumnSelection, KeepsItsToleranceInTheFrobeniusNorm) {
  const Eigen::MatrixXd A = matrix_with_decay(200, 96, 96, 0.8);
  std::size_t before = 0;
  for (const double tolerance : {3e-1, 1e-1, 1e-2, 1e-3, 1e-5}) {
    const ColumnSelection selection = select_columns(A.transpose() * A, tolerance);
    const double error = (A - chosen_columns(A, selection) * selection.weights.transpose()).norm() / A.norm();
    EXPECT_LE(error, tolerance);
    EXPECT_GE(selection.columns.size(), before);
    EXPECT_EQ(selection.columns.size() % kTileStep, 0u);
    before = selection.columns.size();
  }
  EXPECT_LT(before, 96u);
}

TEST(ColumnSelection, KeepsTheChosenColumnsThemselves) {
  const Eigen::MatrixXd A = matrix_with_decay(100, 48, 48, 0.7);
  const ColumnSelection selection = select_columns(A.transpose() * A, 1e-3);
  for (std::size_t k = 0; k < selection.columns.size(); ++k) {
    const Eigen::RowVectorXd unit = Eigen::RowVectorXd::Unit(Index(selection.columns.size()), Index(k));
    EXPECT_LE((selection.weights.row(selection.columns[k]) - unit).cwiseAbs().maxCoeff(), tolerance::normal_equations);
  }
}

TEST(ColumnSelection, ExpressesFurtherColumnsByThoseItKept) {
  const Eigen::MatrixXd A = matrix_with_decay(120, 48, 48, 0.75);
  const Eigen::MatrixXd C = A * Eigen::MatrixXd::Random(48, 30);
  Eigen::MatrixXd gram(78, 48);
  gram << A.transpose() * A, C.transpose() * A;
  const double tolerance = 1e-3;
  const ColumnSelection selection = select_columns(gram, tolerance);
  ASSERT_EQ(selection.weights.rows(), 78);
  const Eigen::MatrixXd fitted = chosen_columns(A, selection) * selection.weights.bottomRows(30).transpose();
  EXPECT_LE((C - fitted).norm(), 10 * tolerance * C.norm());
  EXPECT_LE((chosen_columns(A, selection).transpose() * (C - fitted)).norm(),  // least squares
            tolerance::normal_equations * C.norm() * A.norm());
}

TEST(ColumnSelection, ReadsTheLowerHalfOfTheGramMatrixOnly) {
  const Eigen::MatrixXd A = matrix_with_decay(60, 32, 32, 0.8);
  const Eigen::MatrixXd gram = A.transpose() * A;
  Eigen::MatrixXd lower = gram;
  lower.triangularView<Eigen::StrictlyUpper>().setConstant(std::nan(""));
  const ColumnSelection expected = select_columns(gram, 1e-2), found = select_columns(lower, 1e-2);
  EXPECT_EQ(found.columns, expected.columns);
  EXPECT_EQ(found.weights, expected.weights);
}

TEST(ColumnSelection, OfNothingKeepsNothing) {
  EXPECT_TRUE(select_columns(Eigen::MatrixXd::Zero(20, 20), 1e-3).columns.empty());
  EXPECT_TRUE(select_columns(Eigen::MatrixXd(5, 0), 1e-3).columns.empty());
}

}  // namespace
}  // namespace skinbem
