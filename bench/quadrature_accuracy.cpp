// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// quadrature_accuracy: the element integrals against a table of reference values, class by class.
#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <map>
#include <skinbem/base/error.hpp>
#include <stdexcept>

#include "element_rules.hpp"

namespace {

using namespace skinbem;

struct Options {
  std::string cases = SKINBEM_REFERENCE_FOLDER "/quadrature_cases.csv";
  double tolerance = 1e-12;
  std::string rule = "auto";
};

/// What one case came to.
struct Outcome {
  double error_U, error_T;
  bool missed;
  int evaluations;  ///< of U and T together
  double ns_U, ns_T;
};

/// One line of the table.
struct Summary {
  int cases = 0;
  double error_U = 0, error_T = 0;
  int missed = 0;
  long evaluations = 0;
  std::vector<double> ns_U, ns_T;

  void add(const Outcome& o) {
    ++cases;
    error_U = std::max(error_U, o.error_U);
    error_T = std::max(error_T, o.error_T);
    missed += o.missed ? 1 : 0;
    evaluations += o.evaluations;
    ns_U.push_back(o.ns_U);
    ns_T.push_back(o.ns_T);
  }
};

double median(std::vector<double> values) {
  std::nth_element(values.begin(), values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2), values.end());
  return values[values.size() / 2];
}

/// Nanoseconds a call: the best of three runs of about 50 us each.
template <class Call>
double nanoseconds(Call&& call) {
  using Clock = std::chrono::steady_clock;
  double best = HUGE_VAL;
  for (int run = 0; run < 3; ++run) {
    const auto start = Clock::now();
    double elapsed = 0;
    int calls = 0;
    for (; elapsed < 5e4; ++calls) {
      call();
      elapsed = std::chrono::duration<double, std::nano>(Clock::now() - start).count();
    }
    best = std::min(best, elapsed / calls);
  }
  return best;
}

Outcome measure(const QuadratureCase& c, const std::string& name, double tolerance) {
  const auto rule = make_element_rule(name, c, tolerance);
  ElementBlocks result;
  Outcome o{};
  o.evaluations = rule->integrate_U(result) + rule->integrate_T(result);
  o.error_U = error_of_U(c, result);
  o.error_T = error_of_T(c, result);
  o.missed = o.error_U > std::max(tolerance, 30 * c.condition_U) || o.error_T > std::max(tolerance, 30 * c.condition_T);
  o.ns_U = nanoseconds([&] { rule->integrate_U(result); });
  o.ns_T = nanoseconds([&] { rule->integrate_T(result); });
  return o;
}

void print(const std::string& name, const Summary& s) {
  std::printf("%-24s %5d  %9.2e  %9.2e  %6d  %11ld  %9.0f  %9.0f\n", name.c_str(), s.cases, s.error_U, s.error_T,
              s.missed, s.evaluations / (2 * s.cases), median(s.ns_U), median(s.ns_T));
}

int run(const Options& options) {
  const auto cases = read_quadrature_cases(options.cases);
  std::map<std::string, Summary> groups;
  Summary all;
  for (const QuadratureCase& c : cases) {
    Outcome o;
    try {
      o = measure(c, options.rule, options.tolerance);
    } catch (const std::invalid_argument& error) {
      throw Error(ErrorCode::bad_input, options.cases + ":" + std::to_string(c.line) + ": " + error.what());
    }
    groups[c.group].add(o);
    all.add(o);
    if (o.missed)
      std::fprintf(stderr, "%s:%zu: case %s (%s) misses: error of U %.2e, of T %.2e; 30 cond is %.2e, %.2e\n",
                   options.cases.c_str(), c.line, c.id.c_str(), c.group.c_str(), o.error_U, o.error_T,
                   30 * c.condition_U, 30 * c.condition_T);
  }
  std::printf("rule %s, tolerance %.1e, errors relative to the largest entry of the 3 x 3 block\n",
              options.rule.c_str(), options.tolerance);
  std::printf("%-24s %5s  %9s  %9s  %6s  %11s  %9s  %9s\n", "class", "cases", "error U", "error T", "missed",
              "evaluations", "ns U", "ns T");
  for (const auto& [name, summary] : groups) print(name, summary);
  print("all", all);
  std::printf(
      "evaluations: mean number of kernel evaluations for a triangle (U or T, three hats); ns: median time of it\n");
  return all.missed > 0 ? 1 : 0;
}

}  // namespace

int main(int argc, char** argv) {
  Options options;
  CLI::App app{
      "Errors and costs of the integrals of Kelvin's kernels over flat triangles.\nExit code 1: a case misses "
      "max(tolerance, 30 cond); "
      "2 usage, 3 bad table, 5 table cannot be read."};
  app.add_option("--cases", options.cases, "table of reference integrals (CSV)")->capture_default_str();
  app.add_option("--tolerance", options.tolerance, "asked of the rule, relative to the largest entry of a block")
      ->check(CLI::Range(1e-15, 0.1))
      ->capture_default_str();
  app.add_option("--rule", options.rule, "way to integrate")
      ->check(CLI::IsMember(element_rule_names()))
      ->capture_default_str();
  try {
    app.parse(argc, argv);
    return run(options);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(ErrorCode::usage);
  } catch (const Error& error) {
    std::cerr << error.what() << '\n';
    return static_cast<int>(error.code());
  }
}
