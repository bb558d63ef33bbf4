// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The ways to integrate a kernel over one triangle that quadrature_accuracy compares.
#pragma once

#include <memory>
#include <skinbem/operator/rule_ladder.hpp>
#include <string>
#include <vector>

#include "quadrature_cases.hpp"

namespace skinbem {

/// One way to integrate, made ready for one case: what is known of the triangle and the kernel alone is done
/// beforehand, as an operator does it; what depends on the field point belongs to the calls, which are timed. A rule of
/// your own derives from this: examples/own_rule.cpp.
class ElementRule {
 public:
  virtual ~ElementRule() = default;
  /// Sets result.U; returns the number of kernel evaluations (0 for a closed form).
  virtual int integrate_U(ElementBlocks& result) const = 0;
  /// Sets result.T; returns the number of kernel evaluations.
  virtual int integrate_T(ElementBlocks& result) const = 0;
};

/// auto: what the library's operator does, the cheapest way that meets the tolerance. near: the singularity-cancelling
/// Gauss rule. closed: the closed form in double. gauss: a rule for smooth integrands, which shows what happens without
/// the others; gauss<degree>: one fixed rule of the ladder.
std::vector<std::string> element_rule_names();

/// The rule of that name with Kelvin's kernel for a case (which must outlive it), its orders chosen for `tolerance`,
/// relative to the largest entry of a block. Throws Error(usage) for another name, and whatever the rule throws at
/// degenerate input.
std::unique_ptr<ElementRule> make_element_rule(const std::string& name, const QuadratureCase& c, double tolerance);

/// gauss<degree>.
std::string gauss_rule_name(const MeasuredRule& rule);

/// |x - centroid| over the largest distance from the centroid to a vertex: what the ladder of Gauss rules goes by.
double radius_ratio(const QuadratureCase& c);

/// Throws Error(usage).
[[noreturn]] void fail_unknown_rule(const std::string& name);

}  // namespace skinbem
