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

}  // namespace
}  // namespace skinbem
