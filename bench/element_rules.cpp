// SPDX-License-Identifier: BSD-3-Clause
#include "element_rules.hpp"

#include <algorithm>
#include <cmath>
#include <skinbem/base/error.hpp>
#include <skinbem/kernels/kelvin.hpp>
#include <skinbem/quadrature/closed_form.hpp>
#include <skinbem/quadrature/near_singular.hpp>
#include <skinbem/quadrature/triangle_rules.hpp>

namespace skinbem {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Blocks = std::array<Matrix3d, 3>;

Kelvin<double> kernel_of(const QuadratureCase& c) { return {c.poisson, 1.0}; }

TriangleGeometry<double> geometry_of(const QuadratureCase& c) { return {c.vertices[0], c.vertices[1], c.vertices[2]}; }

void add(Blocks& blocks, const Vector3d& hats, double weight, const Matrix3d& value) {
  for (int v = 0; v < 3; ++v) blocks[v] += weight * hats[v] * value;
}

/// The singularity-cancelling Gauss rule.
class NearRule : public ElementRule {
 public:
  explicit NearRule(double tolerance) : tolerance_(tolerance) {}
  std::string name() const override { return "near"; }

  int integrate_U(const QuadratureCase& c, ElementBlocks& result) const override {
    const auto kernel = kernel_of(c);
    return integrate(c, result.U, [&](const Vector3d& r) { return kernel.single_layer(r); });
  }
  int integrate_T(const QuadratureCase& c, ElementBlocks& result) const override {
    const auto kernel = kernel_of(c);
    return integrate(c, result.T, [&](const Vector3d& r) { return kernel.double_layer(r, Vector3d::UnitZ()); });
  }

 private:
  template <class Value>
  int integrate(const QuadratureCase& c, Blocks& blocks, Value&& value) const {
    const auto geometry = geometry_of(c);
    const NearSingularRule rule(geometry, c.x, tolerance_);
    blocks.fill(Matrix3d::Zero());
    int count = 0;
    rule.for_each([&](const Vector3d& r, const Vector3d& hats, double weight) {
      add(blocks, hats, weight, value(r));
      ++count;
    });
    for (Matrix3d& block : blocks) block = (rule.frame().transpose() * block * rule.frame()).eval();
    return count;
  }

  double tolerance_;
};

/// A rule for smooth integrands, of the degree that a singularity at the centroid's distance asks for.
class GaussOnlyRule : public ElementRule {
 public:
  explicit GaussOnlyRule(double tolerance) : digits_(-std::log(tolerance)) {
    for (int n = 2; n <= largest; ++n) collapsed_.push_back(collapsed_triangle_rule(n));
  }
  std::string name() const override { return "gauss"; }

  int integrate_U(const QuadratureCase& c, ElementBlocks& result) const override {
    const auto kernel = kernel_of(c);
    return integrate(c, result.U, [&](const Vector3d& r) { return kernel.single_layer(r); });
  }
  int integrate_T(const QuadratureCase& c, ElementBlocks& result) const override {
    const auto kernel = kernel_of(c);
    const Vector3d normal = geometry_of(c).normal;
    return integrate(c, result.T, [&](const Vector3d& r) { return kernel.double_layer(r, normal); });
  }

 private:
  static constexpr int largest = 40;

  /// Taylor's series about the centroid converges like (radius / distance)^degree.
  const TriangleRule& choose(const QuadratureCase& c) const {
    const Vector3d centroid = (c.vertices[0] + c.vertices[1] + c.vertices[2]) / 3;
    double radius = 0;
    for (const Vector3d& v : c.vertices) radius = std::max(radius, (v - centroid).norm());
    const double rate = std::log(std::max((c.x - centroid).norm() / radius, 1.1));
    const int degree = static_cast<int>(std::min(std::ceil((digits_ + 3) / rate), 2.0 * largest - 2));
    if (degree <= max_symmetric_degree) return symmetric_triangle_rule(std::max(degree, 1));
    return collapsed_[(degree + 3) / 2 - 2];
  }

  template <class Value>
  int integrate(const QuadratureCase& c, Blocks& blocks, Value&& value) const {
    const TriangleRule& rule = choose(c);
    const double area = 0.5 * geometry_of(c).twice_area;
    blocks.fill(Matrix3d::Zero());
    for (int q = 0; q < rule.size(); ++q) {
      const Vector3d hats = rule.barycentric.col(q);
      const Vector3d y = hats[0] * c.vertices[0] + hats[1] * c.vertices[1] + hats[2] * c.vertices[2];
      if (y == c.x) continue;
      add(blocks, hats, area * rule.weights[q], value(y - c.x));
    }
    return rule.size();
  }

  double digits_;
  std::vector<TriangleRule> collapsed_;  ///< n = 2 ... largest
};

/// The closed form: no kernel evaluation at all.
class ClosedRule : public ElementRule {
 public:
  std::string name() const override { return "closed"; }

  int integrate_U(const QuadratureCase& c, ElementBlocks& result) const override {
    const auto kernel = kernel_of(c);
    const auto moments = single_layer_moments(geometry_of(c), c.x);
    for (int v = 0; v < 3; ++v) result.U[v] = kernel.single_layer_integral(moments[v]);
    return 0;
  }
  int integrate_T(const QuadratureCase& c, ElementBlocks& result) const override {
    const auto kernel = kernel_of(c);
    const auto geometry = geometry_of(c);
    const auto moments = double_layer_moments(geometry, c.x);
    for (int v = 0; v < 3; ++v) result.T[v] = kernel.double_layer_integral(moments[v], geometry.normal);
    return 0;
  }
};

}  // namespace

std::vector<std::string> element_rule_names() { return {"gauss", "near", "closed"}; }

std::unique_ptr<ElementRule> make_element_rule(const std::string& name, double tolerance) {
  if (name == "near") return std::make_unique<NearRule>(tolerance);
  if (name == "gauss") return std::make_unique<GaussOnlyRule>(tolerance);
  if (name == "closed") return std::make_unique<ClosedRule>();
  throw Error(ErrorCode::usage, "no quadrature rule is called '" + name + "'");
}

}  // namespace skinbem
