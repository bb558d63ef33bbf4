// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The ways to integrate Kelvin's kernels over one triangle that quadrature_accuracy compares.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "quadrature_cases.hpp"

namespace skinbem {

/// One way to integrate, made ready for one case: what is known of the triangle and the kernel alone is done
/// beforehand, as an operator does it; what depends on the field point belongs to the calls, which are timed. A rule of
/// your own: derive, and add its name to element_rules.cpp.
class ElementRule {
 public:
  virtual ~ElementRule() = default;
  /// Sets result.U; returns the number of kernel evaluations (0 for a closed form).
  virtual int integrate_U(ElementBlocks& result) const = 0;
  /// Sets result.T; returns the number of kernel evaluations.
  virtual int integrate_T(ElementBlocks& result) const = 0;
};

/// auto: what the library's operator does, the cheapest way that meets the tolerance. near: the singularity-cancelling
/// Gauss rule. closed: the closed form. gauss: a rule for smooth integrands, which shows what happens without the
/// others.
std::vector<std::string> element_rule_names();

/// The rule of that name for a case (which must outlive it), with its orders chosen for `tolerance`, relative to the
/// largest entry of a block. Throws Error(usage) for another name, and whatever the rule throws at degenerate input.
std::unique_ptr<ElementRule> make_element_rule(const std::string& name, const QuadratureCase& c, double tolerance);

}  // namespace skinbem
