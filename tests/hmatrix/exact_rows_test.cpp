// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <set>

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

TEST(RandomVertices, AreDifferentAndTheSameEveryTime) {
  const std::vector<std::int32_t> drawn = random_vertices(1000, 16);
  EXPECT_EQ(drawn.size(), 16u);
  EXPECT_EQ(std::set(drawn.begin(), drawn.end()).size(), 16u);
  EXPECT_EQ(drawn, random_vertices(1000, 16));
  EXPECT_NE(drawn, random_vertices(1001, 16));
}

TEST(ExactRows, OfASmallMeshAreAllOfThem) {
  const Collocation<Kelvin<double>> collocation(cube(1), {0.3, 1.0});
  const ExactRows rows(collocation, random_vertices(8, 100));
  const Eigen::MatrixXd V = Eigen::MatrixXd::Random(24, 2);
  EXPECT_EQ(rows.pick(V).rows(), 24);
  // the norm of all is no estimate
  EXPECT_LE((rows.estimate_norms(rows.pick(V)) - V.colwise().norm()).cwiseAbs().maxCoeff(), tolerance::rounding * 10);
}

}  // namespace
}  // namespace skinbem
