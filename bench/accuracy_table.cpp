// SPDX-License-Identifier: BSD-3-Clause
#include "accuracy_table.hpp"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>

namespace skinbem {
namespace {

/// Nanoseconds a call.
template <class Call>
double nanoseconds(double run_ns, Call&& call) {
  using Clock = std::chrono::steady_clock;
  double best = HUGE_VAL;
  for (int run = 0; run < 3; ++run) {
    const auto start = Clock::now();
    double elapsed = 0;
    int calls = 0;
    for (; elapsed < run_ns; ++calls) {
      call();
      elapsed = std::chrono::duration<double, std::nano>(Clock::now() - start).count();
    }
    best = std::min(best, elapsed / calls);
  }
  return best;
}

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

}  // namespace

bool RuleMeasurement::misses(const QuadratureCase& c, double tolerance) const {
  return error_U > std::max(tolerance, 30 * c.condition_U) || error_T > std::max(tolerance, 30 * c.condition_T);
}

RuleMeasurement measure(const ElementRule& rule, const QuadratureCase& c, double run_ns) {
  ElementBlocks result;
  RuleMeasurement m{};
  m.evaluations = rule.integrate_U(result) + rule.integrate_T(result);
  m.error_U = error_of_U(c, result);
  m.error_T = error_of_T(c, result);
  m.ns_U = nanoseconds(run_ns, [&] { rule.integrate_U(result); });
  m.ns_T = nanoseconds(run_ns, [&] { rule.integrate_T(result); });
  return m;
}

void AccuracyRow::add(const RuleMeasurement& measured, bool missed) {
  ++cases_;
  error_U_ = std::max(error_U_, measured.error_U);
  error_T_ = std::max(error_T_, measured.error_T);
  missed_ += missed ? 1 : 0;
  evaluations_ += measured.evaluations;
  ns_U_.push_back(measured.ns_U);
  ns_T_.push_back(measured.ns_T);
}

void AccuracyRow::print_header(const char* first_column) {
  std::printf("%-24s %5s  %9s  %9s  %6s  %11s  %9s  %9s\n", first_column, "cases", "error U", "error T", "missed",
              "evaluations", "ns U", "ns T");
}

void AccuracyRow::print(const std::string& name) const {
  if (cases_ == 0) return;
  std::printf("%-24s %5d  %9.2e  %9.2e  %6d  %11ld  %9.0f  %9.0f\n", name.c_str(), cases_, error_U_, error_T_, missed_,
              evaluations_ / (2 * cases_), median(ns_U_), median(ns_T_));
}

}  // namespace skinbem
