// SPDX-License-Identifier: BSD-3-Clause
#include "element_rules.hpp"

#include <algorithm>
#include <skinbem/base/error.hpp>
#include <skinbem/kernels/kelvin.hpp>

#include "kernel_rules.hpp"

namespace skinbem {

std::string gauss_rule_name(const MeasuredRule& rule) { return "gauss" + std::to_string(rule.rule.degree); }

std::vector<std::string> element_rule_names() {
  std::vector<std::string> names = {"auto", "gauss", "near", "closed"};
  for (const MeasuredRule& m : measured_rules()) names.push_back(gauss_rule_name(m));
  return names;
}

std::unique_ptr<ElementRule> make_element_rule(const std::string& name, const QuadratureCase& c, double tolerance) {
  return make_kernel_rule(name, Kelvin<double>{c.poisson, 1.0}, c, tolerance);
}

double radius_ratio(const QuadratureCase& c) {
  const auto& v = c.vertices;
  const Eigen::Vector3d centroid = (v[0] + v[1] + v[2]) / 3;
  return (c.x - centroid).norm() /
         std::max({(v[0] - centroid).norm(), (v[1] - centroid).norm(), (v[2] - centroid).norm()});
}

void fail_unknown_rule(const std::string& name) {
  throw Error(ErrorCode::usage, "no quadrature rule is called '" + name + "'");
}

}  // namespace skinbem
