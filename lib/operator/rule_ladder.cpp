// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/operator/rule_ladder.hpp>

#include <cmath>

#include <skinbem/base/error.hpp>

namespace skinbem {

const std::vector<MeasuredRule>& measured_rules() {
  static const std::vector<MeasuredRule> rules = {
      {symmetric_triangle_rule(2), {0.033, 0.27}},     {symmetric_triangle_rule(4), {0.0078, 0.075}},
      {symmetric_triangle_rule(5), {0.012, 0.19}},     {symmetric_triangle_rule(6), {0.0034, 0.058}},
      {symmetric_triangle_rule(7), {0.0022, 0.056}},   {symmetric_triangle_rule(8), {0.0013, 0.019}},
      {symmetric_triangle_rule(9), {4.2e-4, 0.017}},   {symmetric_triangle_rule(10), {1.0e-4, 0.0024}},
      {symmetric_triangle_rule(11), {9.5e-5, 0.0016}}, {symmetric_triangle_rule(12), {1.0e-5, 2.8e-4}},
      {symmetric_triangle_rule(13), {1.1e-5, 8.5e-4}}, {symmetric_triangle_rule(14), {6.0e-6, 1.9e-4}},
      {collapsed_triangle_rule(9), {3.7e-7, 3.6e-5}},  {collapsed_triangle_rule(10), {6.6e-8, 7.4e-6}},
  };
  return rules;
}

double MeasuredRule::error(double ratio, int singularity) const {
  return constant[singularity - 1] * std::pow(ratio - shift, -rule.degree);
}

double MeasuredRule::ratio(double error, int singularity) const {
  return shift + std::pow(constant[singularity - 1] / error, 1.0 / rule.degree);
}

void QuadratureOptions::validate() const {
  if (!(tolerance >= smallest_tolerance && tolerance <= 1e-1)) {
    throw Error(ErrorCode::usage, "quadrature tolerance must lie between 1e-13 and 1e-1");
  }
}

RuleLadder::RuleLadder(double tolerance, int singularity) {
  QuadratureOptions{tolerance}.validate();
  constexpr double closest = 1.6;  // nearer, close to a vertex, errors are up to 200 times those of the model
  for (const MeasuredRule& measured : measured_rules()) {
    const double clamped = std::max(measured.ratio(tolerance, singularity), closest);
    if (!rungs_.empty() && clamped * clamped >= rungs_.back().min_ratio2) continue;  // no nearer than a cheaper rule
    rungs_.push_back({&measured.rule, clamped * clamped});
  }
}

}  // namespace skinbem
