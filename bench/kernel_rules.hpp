// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The library's ways to integrate, for any kernel with 3 x 3 blocks (the interface at the top of kernels/kelvin.hpp).
#pragma once

#include <algorithm>
#include <cmath>
#include <skinbem/operator/element_integral.hpp>
#include <skinbem/quadrature/closed_form.hpp>
#include <skinbem/quadrature/near_singular.hpp>
#include <skinbem/quadrature/triangle_rules.hpp>

#include "element_rules.hpp"

namespace skinbem {

/// What all rules keep of a case.
template <class Kernel>
class RuleOfKernel : public ElementRule {
 public:
  RuleOfKernel(const Kernel& kernel, const QuadratureCase& c)
      : kernel_(kernel), x_(c.x), geometry_(c.vertices[0], c.vertices[1], c.vertices[2]) {}

 protected:
  using Vector = Eigen::Vector3d;
  using Blocks = std::array<Eigen::Matrix3d, 3>;

  static void add(Blocks& blocks, const Vector& hats, double weight, const Eigen::Matrix3d& value) {
    for (int v = 0; v < 3; ++v) blocks[v] += weight * hats[v] * value;
  }

  Kernel kernel_;
  Vector x_;
  TriangleGeometry<double> geometry_;
};

/// quadrature/near_singular.hpp.
template <class Kernel>
class NearRule : public RuleOfKernel<Kernel> {
 public:
  NearRule(const Kernel& kernel, const QuadratureCase& c, double tolerance)
      : RuleOfKernel<Kernel>(kernel, c), tolerance_(tolerance) {}
  int integrate_U(ElementBlocks& result) const override {
    return integrate(result.U, [&](const auto& r) { return this->kernel_.single_layer(r); });
  }
  int integrate_T(ElementBlocks& result) const override {
    return integrate(result.T, [&](const auto& r) { return this->kernel_.double_layer(r, Eigen::Vector3d::UnitZ()); });
  }

 private:
  template <class Value>
  int integrate(typename NearRule::Blocks& blocks, Value&& value) const {
    const NearSingularRule rule(this->geometry_, this->x_, tolerance_);
    blocks.fill(Eigen::Matrix3d::Zero());
    int count = 0;
    rule.for_each([&](const Eigen::Vector3d& r, const Eigen::Vector3d& hats, double weight) {
      this->add(blocks, hats, weight, value(r));
      ++count;
    });
    for (Eigen::Matrix3d& block : blocks) block = (rule.frame().transpose() * block * rule.frame()).eval();
    return count;
  }

  double tolerance_;
};

/// A rule for smooth integrands, of a given degree or of the degree that a tolerance asks for: Taylor's series about
/// the centroid converges like (radius / distance)^degree.
template <class Kernel>
class SmoothRule : public RuleOfKernel<Kernel> {
 public:
  SmoothRule(const Kernel& kernel, const QuadratureCase& c, const TriangleRule& rule)
      : RuleOfKernel<Kernel>(kernel, c), rule_(rule) {}
  SmoothRule(const Kernel& kernel, const QuadratureCase& c, double tolerance) : RuleOfKernel<Kernel>(kernel, c) {
    const double degree = std::ceil((3.0 - std::log(tolerance)) / std::log(std::max(radius_ratio(c), 1.1)));
    rule_ = degree <= max_symmetric_degree ? symmetric_triangle_rule(static_cast<int>(degree))
                                           : collapsed_triangle_rule(static_cast<int>(std::min(degree / 2 + 2, 40.0)));
  }
  int integrate_U(ElementBlocks& result) const override {
    return integrate(result.U, [&](const auto& r) { return this->kernel_.single_layer(r); });
  }
  int integrate_T(ElementBlocks& result) const override {
    return integrate(result.T, [&](const auto& r) { return this->kernel_.double_layer(r, this->geometry_.normal); });
  }

 private:
  template <class Value>
  int integrate(typename SmoothRule::Blocks& blocks, Value&& value) const {
    const auto& v = this->geometry_.vertices;
    blocks.fill(Eigen::Matrix3d::Zero());
    for (int q = 0; q < rule_.size(); ++q) {
      const Eigen::Vector3d hats = rule_.barycentric.col(q);
      const Eigen::Vector3d r = hats[0] * v[0] + hats[1] * v[1] + hats[2] * v[2] - this->x_;
      if (!r.isZero(0)) this->add(blocks, hats, 0.5 * this->geometry_.twice_area * rule_.weights[q], value(r));
    }
    return rule_.size();
  }

  TriangleRule rule_;
};

/// quadrature/closed_form.hpp, in double wherever the point is.
template <class Kernel>
class ClosedFormRule : public RuleOfKernel<Kernel> {
 public:
  using RuleOfKernel<Kernel>::RuleOfKernel;
  int integrate_U(ElementBlocks& result) const override {
    const auto moments = single_layer_moments(this->geometry_, this->x_);
    for (int v = 0; v < 3; ++v) result.U[v] = this->kernel_.single_layer_integral(moments[v]);
    return 0;
  }
  int integrate_T(ElementBlocks& result) const override {
    const auto moments = double_layer_moments(this->geometry_, this->x_);
    for (int v = 0; v < 3; ++v) result.T[v] = this->kernel_.double_layer_integral(moments[v], this->geometry_.normal);
    return 0;
  }
};

/// What the operator does, lib/operator/element_integral.hpp.
template <class Kernel>
class OperatorRule : public ElementRule {
 public:
  OperatorRule(const Kernel& kernel, const QuadratureCase& c, double tolerance)
      : x_(c.x), triangle_(c.vertices[0], c.vertices[1], c.vertices[2]), integral_({kernel, &count_}, tolerance) {}
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
  /// The kernel, counting how often it is asked.
  struct Counting : Kernel {
    int* count;
    typename Kernel::Block single_layer(const Eigen::Vector3d& r) const {
      ++*count;
      return Kernel::single_layer(r);
    }
    typename Kernel::Block double_layer(const Eigen::Vector3d& r, const Eigen::Vector3d& n) const {
      ++*count;
      return Kernel::double_layer(r, n);
    }
  };

  mutable int count_ = 0;
  Eigen::Vector3d x_;
  SourceTriangle triangle_;
  ElementIntegral<Counting> integral_;
};

/// make_element_rule (element_rules.hpp) for a kernel of your own.
template <class Kernel>
std::unique_ptr<ElementRule> make_kernel_rule(const std::string& name, const Kernel& kernel, const QuadratureCase& c,
                                              double tolerance) {
  if (name == "auto") return std::make_unique<OperatorRule<Kernel>>(kernel, c, tolerance);
  if (name == "gauss") return std::make_unique<SmoothRule<Kernel>>(kernel, c, tolerance);
  if (name == "near") return std::make_unique<NearRule<Kernel>>(kernel, c, tolerance);
  if (name == "closed") return std::make_unique<ClosedFormRule<Kernel>>(kernel, c);
  for (const MeasuredRule& m : measured_rules())
    if (name == gauss_rule_name(m)) return std::make_unique<SmoothRule<Kernel>>(kernel, c, m.rule);
  fail_unknown_rule(name);
}

}  // namespace skinbem
