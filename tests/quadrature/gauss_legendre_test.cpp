// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <skinbem/quadrature/gauss_legendre.hpp>
#include <thread>

#include "tolerances.hpp"

namespace skinbem {
namespace {

double integrate_power(const GaussView& rule, int power) {
  double sum = 0;
  for (int q = 0; q < rule.size(); ++q) sum += rule.weights[q] * std::pow(rule.nodes[q], power);
  return sum;
}

TEST(GaussLegendre, IsExactToDegreeTwiceItsPointsLessOne) {
  for (int n = 1; n <= max_cached_gauss_order; ++n) {
    const GaussView rule = gauss_legendre(n);
    for (int power : {0, 1, n, 2 * n - 2, 2 * n - 1})
      EXPECT_NEAR(integrate_power(rule, power) * (power + 1), 1.0, tolerance::rounding) << n << " points, x^" << power;
  }
}

TEST(GaussLegendre, IsNotExactOneDegreeHigher) {
  for (int n = 1; n <= 8; ++n) EXPECT_LT(integrate_power(gauss_legendre(n), 2 * n) * (2 * n + 1), 1.0 - 1e-9);
}

TEST(GaussLegendre, HasAscendingSymmetricNodesInsideAndPositiveWeights) {
  for (int n = 1; n <= max_cached_gauss_order; ++n) {
    const GaussView rule = gauss_legendre(n);
    for (int q = 0; q < n; ++q) {
      EXPECT_GT(rule.nodes[q], q == 0 ? 0.0 : rule.nodes[q - 1]);
      EXPECT_GT(rule.weights[q], 0.0);
      EXPECT_NEAR(rule.nodes[q] + rule.nodes[n - 1 - q], 1.0, tolerance::rounding);
    }
    EXPECT_LT(rule.nodes[n - 1], 1.0);
  }
}

TEST(GaussLegendre, MatchesTheClosedFormOfThreePoints) {
  const GaussView rule = gauss_legendre(3);
  EXPECT_DOUBLE_EQ(rule.nodes[0], 0.5 - 0.5 * std::sqrt(0.6));
  EXPECT_DOUBLE_EQ(rule.nodes[1], 0.5);
  EXPECT_DOUBLE_EQ(rule.weights[0], 5.0 / 18);
  EXPECT_DOUBLE_EQ(rule.weights[1], 4.0 / 9);
}

TEST(GaussLegendre, RefusesOrdersOutOfRange) {
  EXPECT_THROW(gauss_legendre(0), std::invalid_argument);
  EXPECT_THROW(gauss_legendre(max_cached_gauss_order + 1), std::invalid_argument);
  EXPECT_THROW(make_gauss_legendre<double>(-3), std::invalid_argument);
}

TEST(GaussLegendre, GivesEveryThreadTheSameRule) {
  std::vector<const double*> seen(4);
  std::vector<std::thread> threads;
  for (auto& s : seen) threads.emplace_back([&s] { s = gauss_legendre(77).nodes.data(); });
  for (auto& t : threads) t.join();
  for (const double* s : seen) EXPECT_EQ(s, seen[0]);
}

}  // namespace
}  // namespace skinbem
