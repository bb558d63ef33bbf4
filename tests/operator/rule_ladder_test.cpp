// SPDX-License-Identifier: BSD-3-Clause
// The error model of the rule ladder, measured again.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <random>
#include <skinbem/kernels/kelvin.hpp>
#include <skinbem/operator/rule_ladder.hpp>
#include <skinbem/quadrature/closed_form.hpp>

#include "tolerances.hpp"

namespace skinbem {
namespace {

using Real = long double;
using Vector = Eigen::Matrix<Real, 3, 1>;
using Block = Eigen::Matrix<Real, 3, 3>;
using Blocks = std::array<Block, 3>;
using Corners = std::array<Vector, 3>;

class Sampler {
 public:
  Real uniform(Real low, Real high) { return std::uniform_real_distribution<Real>(low, high)(random_); }

  /// Corners of a triangle about its centroid, the farthest at distance 1: any shape, needles and caps down to 1:100.
  Corners triangle() {
    const Real height = std::pow(10.0L, uniform(-2, 0));
    const Real foot = uniform(0, 1);
    Corners corners = {Vector(0, 0, 0), Vector(1, 0, 0), Vector(foot, height, 0)};
    const Vector centroid = (corners[0] + corners[1] + corners[2]) / 3;
    Real radius = 0;
    for (Vector& c : corners) radius = std::max(radius, (c -= centroid).norm());
    for (Vector& c : corners) c /= radius;
    return corners;
  }

  /// Where a point may stand: anywhere, in the plane, in line with a vertex (the worst), straight above.
  Vector direction(const Corners& corners) {
    const int kind = std::uniform_int_distribution<int>(0, 3)(random_);
    const Vector vertex = corners[std::uniform_int_distribution<std::size_t>(0, 2)(random_)];
    if (kind == 0) return Vector(uniform(-1, 1), uniform(-1, 1), uniform(-1, 1)).normalized();
    if (kind == 1) return Vector(uniform(-1, 1), uniform(-1, 1), 0).normalized();
    if (kind == 2) return (vertex.normalized() + Vector(0, 0, uniform(-0.3L, 0.3L))).normalized();
    return Vector(0, 0, 1);
  }

 private:
  std::mt19937 random_{7};
};

Blocks by_rule(const Kelvin<Real>& kernel, const Corners& corners, const Vector& x, const TriangleRule& rule, int p) {
  const Real area = (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm() / 2;
  Blocks sum = {Block::Zero(), Block::Zero(), Block::Zero()};
  for (int q = 0; q < rule.size(); ++q) {
    const Vector b = rule.barycentric.col(q).cast<Real>();
    const Vector r = b[0] * corners[0] + b[1] * corners[1] + b[2] * corners[2] - x;
    const Block value = (p == 1 ? kernel.single_layer(r) : kernel.double_layer(r, Vector::UnitZ())) * rule.weights[q];
    for (int v = 0; v < 3; ++v) sum[v] += b[v] * area * value;
  }
  return sum;
}

/// Closed form near the triangle; farther away, where it cancels, a rule whose error is below that of double.
Blocks exact(const Kelvin<Real>& kernel, const Corners& corners, const Vector& x, int p) {
  static const TriangleRule fine = collapsed_triangle_rule(20);
  if (x.norm() > 2.5) return by_rule(kernel, corners, x, fine, p);
  const TriangleGeometry<Real> g(corners[0], corners[1], corners[2]);
  Blocks blocks;
  if (p == 1) {
    const auto m = single_layer_moments(g, x);
    for (int v = 0; v < 3; ++v) blocks[v] = kernel.single_layer_integral(m[v]);
  } else {
    const auto m = double_layer_moments(g, x);
    for (int v = 0; v < 3; ++v) blocks[v] = kernel.double_layer_integral(m[v], g.normal);
  }
  return blocks;
}

/// Relative to the largest entry of each block, worst of the three.
double error(const Blocks& a, const Blocks& b) {
  double worst = 0;
  for (int v = 0; v < 3; ++v) {
    worst = std::max(worst, double((a[v] - b[v]).cwiseAbs().maxCoeff() / b[v].cwiseAbs().maxCoeff()));
  }
  return worst;
}

class RuleLadderError : public ::testing::TestWithParam<std::tuple<double, int>> {};

TEST_P(RuleLadderError, IsBelowTheToleranceAndNotATenthOfItAtEveryRung) {
  const auto [requested, p] = GetParam();
  const RuleLadder ladder(requested, p);
  constexpr double poissons[] = {-0.9, 0.0, 0.3, 0.45, 0.5};
  Sampler sampler;
  for (const Rung& rung : ladder.rungs()) {
    double worst = 0;
    for (int sample = 0; sample < 600; ++sample) {
      const Corners corners = sampler.triangle();
      const Real limit = std::sqrt(Real(rung.min_ratio2));
      const Vector x = limit * (sample % 4 == 0 ? sampler.uniform(1, 2) : 1.0L) * sampler.direction(corners);
      const double nu = poissons[sample % 5];
      if (p == 2 && nu == 0.5 && std::abs(x[2]) < 1e-3L * limit)
        continue;  // T vanishes in the plane: nothing to compare
      const Kelvin<Real> kernel{Real(nu), 1.0L};
      worst = std::max(worst, error(by_rule(kernel, corners, x, *rung.rule, p), exact(kernel, corners, x, p)));
    }
    EXPECT_LE(worst, std::max(requested, tolerance::rounding)) << rung.rule->degree << ' ' << rung.min_ratio2;
    const bool held_back = rung.min_ratio2 < 2.5601;  // by the model's validity, not by its tolerance
    if (!held_back && requested > 1e-11) {
      EXPECT_GE(worst, requested / 10) << rung.rule->degree << ' ' << rung.min_ratio2;
    }
    RecordProperty("degree_" + std::to_string(rung.rule->degree), std::to_string(worst / requested));
  }
}

INSTANTIATE_TEST_SUITE_P(Tolerances, RuleLadderError,
                         ::testing::Combine(::testing::Values(1e-3, 1e-5, 1e-7, 1e-9, 1e-11, 1e-12),
                                            ::testing::Values(1, 2)));

TEST(RuleLadder, PrefersCheaperRulesFartherAwayAndNoneTooNear) {
  for (const double requested : {1e-3, 1e-8, 1e-12}) {
    const RuleLadder ladder(requested, 2);
    EXPECT_EQ(ladder.rule(0.999 * ladder.near_ratio2()), nullptr);
    for (std::size_t k = 1; k < ladder.rungs().size(); ++k) {
      EXPECT_LT(ladder.rungs()[k].min_ratio2, ladder.rungs()[k - 1].min_ratio2);
      EXPECT_GT(ladder.rungs()[k].rule->size(), ladder.rungs()[k - 1].rule->size());
      EXPECT_EQ(ladder.rule(ladder.rungs()[k].min_ratio2), ladder.rungs()[k].rule);
    }
  }
  EXPECT_THROW(RuleLadder(1e-14, 2), std::exception);
  EXPECT_THROW(RuleLadder(0.5, 2), std::exception);
}

}  // namespace
}  // namespace skinbem
