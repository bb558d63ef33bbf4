// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <skinbem/quadrature/triangle_rules.hpp>
#include <stdexcept>

#include "tolerances.hpp"

namespace skinbem {
namespace {

/// Mean of l0^i l1^j over the triangle: 2 i! j! / (i + j + 2)!.
double exact_mean(int i, int j) {
  return 2.0 * std::exp(std::lgamma(i + 1) + std::lgamma(j + 1) - std::lgamma(i + j + 3));
}

double mean(const TriangleRule& rule, int i, int j) {
  return (rule.barycentric.row(0).array().pow(i) * rule.barycentric.row(1).array().pow(j) *
          rule.weights.transpose().array())
      .sum();
}

void expect_exact(const TriangleRule& rule) {
  for (int i = 0; i <= rule.degree; ++i)
    for (int j = 0; i + j <= rule.degree; ++j)
      EXPECT_NEAR(mean(rule, i, j), exact_mean(i, j), tolerance::quadrature_rule)
          << rule.size() << " points, " << i << ' ' << j;
}

void expect_inside_and_positive(const TriangleRule& rule) {
  EXPECT_GT(rule.barycentric.minCoeff(), 0.0);
  EXPECT_LT(rule.barycentric.maxCoeff(), 1.0);
  EXPECT_GT(rule.weights.minCoeff(), 0.0);
  EXPECT_NEAR((rule.barycentric.colwise().sum().array() - 1.0).abs().maxCoeff(), 0.0, tolerance::rounding);
}

TEST(SymmetricTriangleRule, IsExactToItsDegreeWithPointsInsideAndPositiveWeights) {
  for (int degree = 1; degree <= max_symmetric_degree; ++degree) {
    const TriangleRule& rule = symmetric_triangle_rule(degree);
    EXPECT_GE(rule.degree, degree);
    expect_exact(rule);
    expect_inside_and_positive(rule);
  }
}

TEST(SymmetricTriangleRule, IsNotExactOneDegreeHigher) {
  for (int degree : {1, 2, 4, 5, 8}) {
    const TriangleRule& rule = symmetric_triangle_rule(degree);
    double worst = 0;
    for (int i = 0; i <= degree + 1; ++i)
      worst = std::max(worst, std::abs(mean(rule, i, degree + 1 - i) / exact_mean(i, degree + 1 - i) - 1));
    EXPECT_GT(worst, 1e-6) << degree;
  }
}

TEST(SymmetricTriangleRule, HasTheNumberOfPointsThatItsHeaderStates) {
  EXPECT_EQ(symmetric_triangle_rule(1).size(), 1);
  EXPECT_EQ(symmetric_triangle_rule(3).size(), 6);
  EXPECT_EQ(symmetric_triangle_rule(5).size(), 7);
  EXPECT_EQ(symmetric_triangle_rule(8).size(), 16);
  EXPECT_EQ(symmetric_triangle_rule(12).size(), 33);
  EXPECT_EQ(symmetric_triangle_rule(14).size(), 42);
}

TEST(SymmetricTriangleRule, RefusesDegreesOutOfRange) {
  EXPECT_THROW(symmetric_triangle_rule(0), std::invalid_argument);
  EXPECT_THROW(symmetric_triangle_rule(max_symmetric_degree + 1), std::invalid_argument);
}

TEST(CollapsedTriangleRule, IsExactToTwiceItsOrderLessTwo) {
  for (int n : {1, 2, 5, 12, 30}) {
    const TriangleRule rule = collapsed_triangle_rule(n);
    EXPECT_EQ(rule.size(), n * n);
    expect_exact(rule);
    expect_inside_and_positive(rule);
  }
}

}  // namespace
}  // namespace skinbem
