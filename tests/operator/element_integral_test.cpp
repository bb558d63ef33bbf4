// SPDX-License-Identifier: BSD-3-Clause
// The operator's element integrals against the tables made in extended precision: ours, of shapes up to an aspect of
// 1000, and the shared one.
#include <gtest/gtest.h>

#include <skinbem/kernels/kelvin.hpp>
#include <skinbem/kernels/laplace.hpp>
#include <skinbem/operator/element_integral.hpp>

#include "../../bench/quadrature_cases.hpp"
#include "files.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using testing_support::project_file;
using testing_support::shared_data;

SourceTriangle triangle_of(const QuadratureCase& c) { return {c.vertices[0], c.vertices[1], c.vertices[2]}; }

void expect_kelvin_met(const std::filesystem::path& table, double requested) {
  for (const QuadratureCase& c : read_quadrature_cases(table)) {
    const SourceTriangle triangle = triangle_of(c);
    const ElementIntegral<Kelvin<double>> integral({c.poisson, 1.0}, requested);
    const ElementBlocks result{integral.single_layer(triangle, c.x), integral.double_layer(triangle, c.x)};
    EXPECT_LE(error_of_U(c, result), std::max(requested, tolerance::conditioning * c.condition_U))
        << c.id << ' ' << c.group;
    EXPECT_LE(error_of_T(c, result), std::max(requested, tolerance::conditioning * c.condition_T))
        << c.id << ' ' << c.group;
  }
}

/// Laplace's integrals are traces of Kelvin's: tr U = (10-12nu)/(16 pi (1-nu)) int N/r, tr T = -3/(4 pi) int N
/// (r.n)/r^3. The conditioning of an entry is taken from Kelvin's block.
void expect_laplace_met(const std::filesystem::path& table, double requested) {
  const ElementIntegral<Laplace<double>> integral({}, requested);
  for (const QuadratureCase& c : read_quadrature_cases(table)) {
    const auto U = integral.single_layer(triangle_of(c), c.x), T = integral.double_layer(triangle_of(c), c.x);
    for (std::size_t v = 0; v < 3; ++v) {
      const double exact_U = c.exact.U[v].trace() * 4 * (1 - c.poisson) / (10 - 12 * c.poisson);
      const double unsure_U = tolerance::conditioning * c.condition_U * c.exact.U[v].cwiseAbs().maxCoeff();
      EXPECT_NEAR(U[v](0), exact_U, std::max(requested * exact_U, unsure_U)) << c.id << ' ' << c.group;
      if (!c.has_T[v]) continue;
      const double exact_T = c.exact.T[v].trace() / 3;
      const double unsure_T = tolerance::conditioning * c.condition_T * c.exact.T[v].cwiseAbs().maxCoeff();
      EXPECT_NEAR(T[v](0), exact_T, std::max(requested * std::abs(exact_T), unsure_T)) << c.id << ' ' << c.group;
    }
  }
}

class ElementIntegralTable : public testing::TestWithParam<double> {};

TEST_P(ElementIntegralTable, OfOurOwnIsMetInEveryCaseByKelvinAndLaplace) {
  expect_kelvin_met(project_file("tests/reference/quadrature_cases.csv"), GetParam());
  expect_laplace_met(project_file("tests/reference/quadrature_cases.csv"), GetParam());
}

TEST_P(ElementIntegralTable, ThatIsSharedIsMetInEveryCaseByKelvinAndLaplace) {
  SKINBEM_NEEDS_SHARED_DATA("reference/quadrature_cases.csv");
  expect_kelvin_met(shared_data("reference/quadrature_cases.csv"), GetParam());
  expect_laplace_met(shared_data("reference/quadrature_cases.csv"), GetParam());
}

INSTANTIATE_TEST_SUITE_P(Tolerances, ElementIntegralTable, testing::Values(1e-3, 1e-6, 1e-8, 1e-10, 1e-12));

}  // namespace
}  // namespace skinbem
