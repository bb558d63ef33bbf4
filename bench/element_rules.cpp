// SPDX-License-Identifier: BSD-3-Clause
#include "element_rules.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <skinbem/base/error.hpp>
#include <skinbem/kernels/kelvin.hpp>
#include <skinbem/operator/element_integral.hpp>
#include <skinbem/quadrature/closed_form.hpp>
#include <skinbem/quadrature/near_singular.hpp>
#include <skinbem/quadrature/triangle_rules.hpp>

namespace skinbem {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;
using Blocks = std::array<Matrix3d, 3>;

void add(Blocks& blocks, const Vector3d& hats, double weight, const Matrix3d& value) {
  for (int v = 0; v < 3; ++v) blocks[v] += weight * hats[v] * value;
}

/// What all rules keep of a case.
class RuleForCase : public ElementRule {
 protected:
  RuleForCase(const QuadratureCase& c, double tolerance)
      : x_(c.x),
        kernel_{c.poisson, 1.0},
        geometry_(c.vertices[0], c.vertices[1], c.vertices[2]),
        tolerance_(tolerance) {}

  Vector3d x_;
  Kelvin<double> kernel_;
  TriangleGeometry<double> geometry_;
  double tolerance_;
};

class NearRule : public RuleForCase {
 public:
  NearRule(const QuadratureCase& c, double tolerance) : RuleForCase(c, tolerance) {}
  int integrate_U(ElementBlocks& result) const override {
    return integrate(result.U, [&](const Vector3d& r) { return kernel_.single_layer(r); });
  }
  int integrate_T(ElementBlocks& result) const override {
    return integrate(result.T, [&](const Vector3d& r) { return kernel_.double_layer(r, Vector3d::UnitZ()); });
  }

 private:
  template <class Value>
  int integrate(Blocks& blocks, Value&& value) const {
    const NearSingularRule rule(geometry_, x_, tolerance_);
    blocks.fill(Matrix3d::Zero());
    int count = 0;
    rule.for_each([&](const Vector3d& r, const Vector3d& hats, double weight) {
      add(blocks, hats, weight, value(r));
      ++count;
    });
    for (Matrix3d& block : blocks) block = (rule.frame().transpose() * block * rule.frame()).eval();
    return count;
  }
};

/// A rule for smooth integrands: Taylor's series about the centroid converges like (radius / distance)^degree.
class GaussRuleOnly : public RuleForCase {
 public:
  GaussRuleOnly(const QuadratureCase& c, double tolerance) : RuleForCase(c, tolerance) {
    const auto& v = geometry_.vertices;
    const Vector3d centroid = (v[0] + v[1] + v[2]) / 3;
    const double radius = std::max({(v[0] - centroid).norm(), (v[1] - centroid).norm(), (v[2] - centroid).norm()});
    const double rate = std::log(std::max((x_ - centroid).norm() / radius, 1.1));
    const double degree = std::ceil((3.0 - std::log(tolerance)) / rate);
    rule_ = degree <= max_symmetric_degree ? symmetric_triangle_rule(static_cast<int>(degree))
                                           : collapsed_triangle_rule(static_cast<int>(std::min(degree / 2 + 2, 40.0)));
  }
  int integrate_U(ElementBlocks& result) const override {
    return integrate(result.U, [&](const Vector3d& r) { return kernel_.single_layer(r); });
  }
  int integrate_T(ElementBlocks& result) const override {
    return integrate(result.T, [&](const Vector3d& r) { return kernel_.double_layer(r, geometry_.normal); });
  }

 private:
  template <class Value>
  int integrate(Blocks& blocks, Value&& value) const {
    const auto& v = geometry_.vertices;
    blocks.fill(Matrix3d::Zero());
    for (int q = 0; q < rule_.size(); ++q) {
      const Vector3d hats = rule_.barycentric.col(q);
      const Vector3d y = hats[0] * v[0] + hats[1] * v[1] + hats[2] * v[2];
      if (y != x_) add(blocks, hats, 0.5 * geometry_.twice_area * rule_.weights[q], value(y - x_));
    }
    return rule_.size();
  }

  TriangleRule rule_;
};

class ClosedFormRule : public RuleForCase {
 public:
  ClosedFormRule(const QuadratureCase& c, double tolerance) : RuleForCase(c, tolerance) {}
  int integrate_U(ElementBlocks& result) const override {
    const auto moments = single_layer_moments(geometry_, x_);
    for (int v = 0; v < 3; ++v) result.U[v] = kernel_.single_layer_integral(moments[v]);
    return 0;
  }
  int integrate_T(ElementBlocks& result) const override {
    const auto moments = double_layer_moments(geometry_, x_);
    for (int v = 0; v < 3; ++v) result.T[v] = kernel_.double_layer_integral(moments[v], geometry_.normal);
    return 0;
  }
};

/// Kelvin's kernel that counts how often it is asked.
struct CountingKelvin : Kelvin<double> {
  int* count;
  Block single_layer(const Vector& r) const {
    ++*count;
    return Kelvin<double>::single_layer(r);
  }
  Block double_layer(const Vector& r, const Vector& n) const {
    ++*count;
    return Kelvin<double>::double_layer(r, n);
  }
};

class OperatorRule : public ElementRule {
 public:
  OperatorRule(const QuadratureCase& c, double tolerance)
      : x_(c.x),
        triangle_(c.vertices[0], c.vertices[1], c.vertices[2]),
        integral_(CountingKelvin{{c.poisson, 1.0}, &count_}, tolerance) {}
  int integrate_U(ElementBlocks& result) const override {
    count_ = 0;
    result.U = integral_.single_layer(triangle_, x_);
    return count_;
  }
  int integrate_T(ElementBlocks& result) const override {
    count_ = 0;
    result.T = integral_.double_layer(triangle_, x_);
    return count_;
  }

 private:
  mutable int count_ = 0;
  Vector3d x_;
  SourceTriangle triangle_;
  ElementIntegral<CountingKelvin> integral_;
};

}  // namespace

std::vector<std::string> element_rule_names() { return {"auto", "gauss", "near", "closed"}; }

std::unique_ptr<ElementRule> make_element_rule(const std::string& name, const QuadratureCase& c, double tolerance) {
  if (name == "auto") return std::make_unique<OperatorRule>(c, tolerance);
  if (name == "gauss") return std::make_unique<GaussRuleOnly>(c, tolerance);
  if (name == "near") return std::make_unique<NearRule>(c, tolerance);
  if (name == "closed") return std::make_unique<ClosedFormRule>(c, tolerance);
  throw Error(ErrorCode::usage, "no quadrature rule is called '" + name + "'");
}

}  // namespace skinbem
