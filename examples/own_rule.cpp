// SPDX-License-Identifier: BSD-3-Clause
// A quadrature rule and a kernel of your own in the table of quadrature_accuracy, beside the library's.
//
// The rule is the plain idea without any transform: halve the triangle until each part is twice as far from the field
// point as it is long, then a Gauss rule on every part. The kernel is that of pseudo_traction.hpp. Both are measured
// over those cases of the project's table whose point is off the triangle and its plane.
#include <skinbem/operator/element_integral.hpp>

#include "../bench/accuracy_table.hpp"
#include "../bench/kernel_rules.hpp"
#include "pseudo_traction.hpp"

using namespace skinbem;

constexpr double requested = 1e-8;

class GradedHalving : public ElementRule {
 public:
  explicit GradedHalving(const QuadratureCase& c)
      : x_(c.x), kernel_{c.poisson, 1.0}, triangle_(c.vertices[0], c.vertices[1], c.vertices[2]) {}

  int integrate_U(ElementBlocks& result) const override {
    result.U.fill(Eigen::Matrix3d::Zero());
    return add(triangle_, Eigen::Matrix3d::Identity(), result.U, [&](auto& r) { return kernel_.single_layer(r); });
  }
  int integrate_T(ElementBlocks& result) const override {
    const Eigen::Vector3d n = triangle_.geometry.normal;
    result.T.fill(Eigen::Matrix3d::Zero());
    return add(triangle_, Eigen::Matrix3d::Identity(), result.T, [&](auto& r) { return kernel_.double_layer(r, n); });
  }

 private:
  /// Adds the integral over `part`, whose vertices have the columns of `hats` as barycentric coordinates in the whole;
  /// returns the number of evaluations.
  template <class Value>
  int add(const SourceTriangle& part, const Eigen::Matrix3d& hats, std::array<Eigen::Matrix3d, 3>& blocks,
          const Value& value) const {
    const auto& v = part.geometry.vertices;
    if (part.distance2(x_) < 4 * part.length() * part.length()) {
      const int k = part.longest, i = (k + 1) % 3, j = (k + 2) % 3;
      const Eigen::Vector3d middle = (v[i] + v[j]) / 2, hats_of_middle = (hats.col(i) + hats.col(j)) / 2;
      Eigen::Matrix3d first, second;
      first << hats.col(k), hats.col(i), hats_of_middle;
      second << hats.col(k), hats_of_middle, hats.col(j);
      return add(SourceTriangle(v[k], v[i], middle), first, blocks, value) +
             add(SourceTriangle(v[k], middle, v[j]), second, blocks, value);
    }
    const TriangleRule& rule = symmetric_triangle_rule(14);
    for (int q = 0; q < rule.size(); ++q) {
      const Eigen::Vector3d b = rule.barycentric.col(q), hat = hats * b;
      const Eigen::Vector3d r = b[0] * v[0] + b[1] * v[1] + b[2] * v[2] - x_;
      const Eigen::Matrix3d weighted = rule.weights[q] * part.geometry.twice_area / 2 * value(r);
      for (int a = 0; a < 3; ++a) blocks[a] += hat[a] * weighted;
    }
    return rule.size();
  }

  Eigen::Vector3d x_;
  Kelvin<double> kernel_;
  SourceTriangle triangle_;
};

/// The cases whose point is at least a hundredth of an edge above the triangle's plane, where the pseudo-traction
/// vanishes.
std::vector<QuadratureCase> cases_off_the_triangle() {
  std::vector<QuadratureCase> cases = read_quadrature_cases(SKINBEM_REFERENCE_FOLDER "/quadrature_cases.csv");
  std::erase_if(cases, [](const QuadratureCase& c) {
    const TriangleGeometry<double> triangle(c.vertices[0], c.vertices[1], c.vertices[2]);
    const double near = 0.01 * longest_edge(c), height = std::abs(triangle.normal.dot(c.x - c.vertices[0]));
    return height < near;
  });
  return cases;
}

/// The case with another kernel: its exact integrals by the near-singular rule, which knows no closed form.
template <class Kernel>
QuadratureCase with_kernel(QuadratureCase c, const Kernel& kernel) {
  const NearRule<Kernel> rule(kernel, c, 1e-15);
  rule.integrate_U(c.exact);
  rule.integrate_T(c.exact);
  return c;
}

int main() {
  AccuracyRow library, own_rule, own_kernel;
  for (const QuadratureCase& c : cases_off_the_triangle()) {
    const auto enter = [](AccuracyRow& row, const QuadratureCase& of, const ElementRule& rule) {
      const RuleMeasurement measured = measure(rule, of);
      row.add(measured, measured.misses(of, requested));
    };
    enter(library, c, *make_element_rule("auto", c, requested));
    enter(own_rule, c, GradedHalving(c));
    const PseudoTraction kernel{{.poisson = c.poisson}};
    enter(own_kernel, with_kernel(c, kernel), *make_kernel_rule("auto", kernel, c, requested));
  }
  AccuracyRow::print_header("rule");
  library.print("auto");
  own_rule.print("graded halving");
  own_kernel.print("auto, pseudo-traction");
  return library.missed() + own_rule.missed() + own_kernel.missed() == 0 ? 0 : 1;
}
