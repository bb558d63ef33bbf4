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
  const ExactRows rows(sphere.collocation, 7);
  const Eigen::MatrixXd V = Eigen::MatrixXd::Random(sphere.H.cols(), 4);
  const Eigen::MatrixXd expected = rows.pick(sphere.H * V), found = rows.multiply(V);
  ASSERT_EQ(found.rows(), 21);
  EXPECT_LE((found - expected).cwiseAbs().maxCoeff(), tolerance::invariance);
}

TEST(ExactRows, PickDifferentVerticesAndTheSameEveryTime) {
  const RowsOfASphere sphere;
  Eigen::MatrixXd numbers(sphere.H.cols(), 1);
  for (Index k = 0; k < numbers.rows(); ++k) numbers(k, 0) = double(k);
  const Eigen::MatrixXd first = ExactRows(sphere.collocation).pick(numbers);
  EXPECT_EQ(first.rows(), 3 * Index(ExactRows::default_count));
  for (Index a = 0; a < first.rows(); ++a) {
    for (Index b = 0; b < a; ++b) EXPECT_NE(first(a, 0), first(b, 0));
  }
  EXPECT_EQ(first, ExactRows(sphere.collocation).pick(numbers));
}

TEST(ExactRows, OfASmallMeshAreAllOfThem) {
  const Collocation<Kelvin<double>> collocation(cube(1), {0.3, 1.0});
  const ExactRows rows(collocation, 100);
  const Eigen::MatrixXd V = Eigen::MatrixXd::Random(24, 2);
  EXPECT_EQ(rows.pick(V).rows(), 24);
  // the norm of all is no estimate
  EXPECT_LE((rows.estimate_norms(rows.pick(V)) - V.colwise().norm()).cwiseAbs().maxCoeff(), tolerance::rounding * 10);
}

}  // namespace
}  // namespace skinbem
