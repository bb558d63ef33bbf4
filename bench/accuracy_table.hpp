// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Errors and costs of rules, case by case and as lines of a table.
#pragma once

#include "element_rules.hpp"

namespace skinbem {

/// One rule in one case.
struct RuleMeasurement {
  double error_U, error_T;  ///< see error_of_U
  int evaluations;          ///< of U and T together
  double ns_U, ns_T;        ///< of the three hat functions: the best of three runs

  /// Whether an error is above the larger of the tolerance and 30 times the conditioning of the case.
  bool misses(const QuadratureCase& c, double tolerance) const;
};

/// `run_ns`: about how long each of the three runs of U and of T may take.
RuleMeasurement measure(const ElementRule& rule, const QuadratureCase& c, double run_ns = 5e4);

/// A line of the table: one rule over some cases.
class AccuracyRow {
 public:
  void add(const RuleMeasurement& measured, bool missed);
  int missed() const { return missed_; }

  static void print_header(const char* first_column);
  /// Largest errors, number of cases that missed, mean number of kernel evaluations and median time for a triangle.
  void print(const std::string& name) const;

 private:
  int cases_ = 0, missed_ = 0;
  double error_U_ = 0, error_T_ = 0;
  long evaluations_ = 0;
  std::vector<double> ns_U_, ns_T_;
};

}  // namespace skinbem
