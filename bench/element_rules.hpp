// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The ways to integrate Kelvin's kernels over one triangle that quadrature_accuracy compares.
#pragma once

#include <memory>
#include <string>
#include <vector>

#include "quadrature_cases.hpp"

namespace skinbem {

/// One way to integrate. A rule of your own: derive, implement the three functions, add it to `element_rules`.
class ElementRule {
 public:
  virtual ~ElementRule() = default;
  /// Sets result.U; returns the number of kernel evaluations (0 for a closed form).
  virtual int integrate_U(const QuadratureCase& c, ElementBlocks& result) const = 0;
  /// Sets result.T; returns the number of kernel evaluations.
  virtual int integrate_T(const QuadratureCase& c, ElementBlocks& result) const = 0;
  /// As the user names it.
  virtual std::string name() const = 0;
};

/// The names that make_element_rule knows.
std::vector<std::string> element_rule_names();

/// The rule of that name, with its orders chosen for `tolerance` (relative to the largest entry of a block). Throws
/// Error(usage) for another name. `gauss` knows nothing of singularities: it shows what happens without the others.
std::unique_ptr<ElementRule> make_element_rule(const std::string& name, double tolerance);

}  // namespace skinbem
