// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// quadrature_accuracy: the element integrals against a table of reference values, class by class, or over a sweep.
#include <CLI/CLI.hpp>
#include <cstdio>
#include <iostream>
#include <map>
#include <skinbem/base/error.hpp>
#include <stdexcept>

#include "accuracy_table.hpp"
#ifdef SKINBEM_HAS_QUADRUPLE
#include "quadrature_sweep.hpp"
#endif

namespace {

using namespace skinbem;

struct Options {
  std::string cases = SKINBEM_REFERENCE_FOLDER "/quadrature_cases.csv";
  double tolerance = 1e-12;
  std::string rule = "auto";
  std::string sweep;
};

int sweep(const std::string& path) {
#ifdef SKINBEM_HAS_QUADRUPLE
  std::printf("%ld rows in %s\n", sweep_quadrature(path), path.c_str());
  return 0;
#else
  throw Error(ErrorCode::usage, path + ": the sweep's reference needs Boost.Multiprecision and libquadmath, without " +
                                    "which this program was built; install libboost-dev and build again");
#endif
}

int compare(const Options& options) {
  const auto cases = read_quadrature_cases(options.cases);
  std::map<std::string, AccuracyRow> groups;
  AccuracyRow all;
  for (const QuadratureCase& c : cases) {
    RuleMeasurement m;
    try {
      m = measure(*make_element_rule(options.rule, c, options.tolerance), c);
    } catch (const std::invalid_argument& error) {
      throw Error(ErrorCode::bad_input, options.cases + ":" + std::to_string(c.line) + ": " + error.what());
    }
    const bool missed = m.misses(c, options.tolerance);
    groups[c.group].add(m, missed);
    all.add(m, missed);
    if (missed)
      std::fprintf(stderr, "%s:%zu: case %s (%s) misses: error of U %.2e, of T %.2e; 30 cond is %.2e, %.2e\n",
                   options.cases.c_str(), c.line, c.id.c_str(), c.group.c_str(), m.error_U, m.error_T,
                   30 * c.condition_U, 30 * c.condition_T);
  }
  std::printf("rule %s, tolerance %.1e, errors relative to the largest entry of the 3 x 3 block\n",
              options.rule.c_str(), options.tolerance);
  AccuracyRow::print_header("class");
  for (const auto& [name, row] : groups) row.print(name);
  all.print("all");
  std::printf(
      "evaluations: mean number of kernel evaluations for a triangle (U or T, three hats); ns: median time of it\n");
  return all.missed() > 0 ? 1 : 0;
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
  app.add_option("--sweep", options.sweep,
                 "write errors and costs of all rules over cases of its own to this CSV file");
  try {
    app.parse(argc, argv);
    return options.sweep.empty() ? compare(options) : sweep(options.sweep);
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : static_cast<int>(ErrorCode::usage);
  } catch (const Error& error) {
    std::cerr << error.what() << '\n';
    return static_cast<int>(error.code());
  }
}
