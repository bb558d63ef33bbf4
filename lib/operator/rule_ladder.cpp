// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/operator/rule_ladder.hpp>

#include <cmath>

#include <skinbem/base/error.hpp>

namespace skinbem {
namespace {

/// A rule and the constants c_m of its error, for kernels like 1/r and like 1/r^2.
struct MeasuredRule {
  TriangleRule rule;
  double constant[2];
};

const std::vector<MeasuredRule>& measured_rules() {
  static const std::vector<MeasuredRule> rules = {
      {symmetric_triangle_rule(2), {0.06, 0.2}},       {symmetric_triangle_rule(4), {0.015, 0.10}},
      {symmetric_triangle_rule(5), {0.018, 0.24}},     {symmetric_triangle_rule(7), {0.0032, 0.13}},
      {symmetric_triangle_rule(8), {0.0040, 0.055}},   {symmetric_triangle_rule(10), {6e-4, 0.009}},
      {symmetric_triangle_rule(12), {2.5e-4, 0.0035}}, {symmetric_triangle_rule(14), {2e-4, 0.004}},
      {collapsed_triangle_rule(10), {5e-6, 2.5e-4}},
  };
  return rules;
}

}  // namespace

void QuadratureOptions::validate() const {
  if (!(tolerance >= 1e-13 && tolerance <= 1e-1)) {
    throw Error(ErrorCode::usage, "quadrature tolerance must lie between 1e-13 and 1e-1");
  }
}

RuleLadder::RuleLadder(double tolerance, int singularity) {
  QuadratureOptions{tolerance}.validate();
  constexpr double closest = 1.6;  // nearer, close to a vertex, errors are up to 200 times those of the model
  for (const MeasuredRule& measured : measured_rules()) {
    const double ratio = std::pow(measured.constant[singularity - 1] / tolerance, 1.0 / measured.rule.degree);
    const double clamped = std::max(ratio, closest);
    if (!rungs_.empty() && clamped * clamped >= rungs_.back().min_ratio2) continue;  // no nearer than a cheaper rule
    rungs_.push_back({&measured.rule, clamped * clamped});
  }
}

}  // namespace skinbem
