// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <skinbem/kernels/laplace.hpp>
#include <skinbem/quadrature/near_singular.hpp>
#include <stdexcept>

#include "element_blocks.hpp"
#include "files.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using Eigen::Vector3d;
using testing_support::near_singular_blocks;

const Vector3d v0(0.1, -0.2, 0.3), v1(1.2, 0.1, 0.4), v2(0.3, 0.9, -0.1);
const TriangleGeometry<double> triangle(v0, v1, v2);

void expect_table_within(const std::filesystem::path& path, double tolerance) {
  for (const QuadratureCase& c : read_quadrature_cases(path)) {
    const auto result = near_singular_blocks(testing_support::geometry_of(c), c.x, c.poisson, tolerance);
    EXPECT_LE(error_of_U(c, result), std::max(tolerance, tolerance::conditioning * c.condition_U))
        << c.id << ' ' << c.group;
    EXPECT_LE(error_of_T(c, result), std::max(tolerance, tolerance::conditioning * c.condition_T))
        << c.id << ' ' << c.group;
  }
}

class NearSingularTolerance : public testing::TestWithParam<double> {};

TEST_P(NearSingularTolerance, IsMetOnEveryCaseOfTheTable) {
  expect_table_within(testing_support::project_file("tests/reference/quadrature_cases.csv"), GetParam());
}

TEST_P(NearSingularTolerance, IsMetOnEveryCaseOfTheSharedTable) {
  SKINBEM_NEEDS_SHARED_DATA("reference/quadrature_cases.csv");
  expect_table_within(testing_support::shared_data("reference/quadrature_cases.csv"), GetParam());
}

INSTANTIATE_TEST_SUITE_P(From1em3To1em13, NearSingularTolerance,
                         testing::Values(1e-3, 1e-4, 1e-5, 1e-6, 1e-7, 1e-8, 1e-9, 1e-10, 1e-11, 1e-12, 1e-13));

TEST(NearSingularRule, TakesFewerPointsForALooserTolerance) {
  for (const Vector3d& x : {Vector3d(0.5, 0.2, 0.25), Vector3d(1.2, 0.1, 0.400001), Vector3d(0.6, -0.3, 0.5)}) {
    int before = 0;
    for (double tolerance = 1e-2; tolerance > 1e-14; tolerance /= 10) {
      const int size = NearSingularRule(triangle, x, tolerance).size();
      EXPECT_GE(size, before) << tolerance;
      before = size;
    }
    EXPECT_GT(before, 2 * NearSingularRule(triangle, x, 1e-2).size());
  }
}

TEST(NearSingularRule, WeightsArePositiveSumToTheAreaAndHatsInterpolate) {
  for (const Vector3d& x :
       {Vector3d(0.5, 0.2, 0.25), v1, Vector3d(0.6, -0.3, 0.5), Vector3d(0.65, -0.05, 0.35 + 1e-7)}) {
    const NearSingularRule rule(triangle, x, 1e-10);
    double area = 0;
    int count = 0;
    rule.for_each([&](const Vector3d& r, const Vector3d& hats, double weight) {
      const Vector3d y = hats[0] * v0 + hats[1] * v1 + hats[2] * v2;
      EXPECT_LT((x + rule.frame().transpose() * r - y).norm(), tolerance::rounding);
      EXPECT_GT(hats.minCoeff(), -tolerance::rounding);
      EXPECT_GT(weight, 0.0);
      area += weight;
      ++count;
    });
    EXPECT_EQ(count, rule.size());
    EXPECT_NEAR(area, 0.5 * triangle.twice_area, 1e-10);
  }
}

TEST(NearSingularRule, AgreesWithTheClosedFormForAnyShapeAndPosition) {
  std::mt19937_64 random(5);
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  for (int trial = 0; trial < 200; ++trial) {
    const double height = std::exp(-std::log(50.0) * uniform());
    const TriangleGeometry<double> t({0, 0, 0}, {1, 0, 0}, {1.4 * uniform() - 0.2, height, 0});
    const double distance = std::exp(std::log(1e-6) * uniform());
    const Vector3d direction(uniform() - 0.5, uniform() - 0.5, uniform() - 0.5);
    const Vector3d x = t.vertices[trial % 3] * uniform() + distance * direction.normalized();
    const double nu = 0.1 * static_cast<double>(trial % 5);
    const auto gauss = near_singular_blocks(t, x, nu, 1e-12);
    const Kelvin<double> kernel{nu, 1.0};
    const auto U = single_layer_moments(t, x);
    const auto T = double_layer_moments(t, x);
    for (int v = 0; v < 3; ++v) {
      const Eigen::Matrix3d exact_U = kernel.single_layer_integral(U[v]);
      const Eigen::Matrix3d exact_T = kernel.double_layer_integral(T[v], t.normal);
      const double slack = tolerance::closed_form_against_gauss / (height * height);
      EXPECT_LT((gauss.U[v] - exact_U).norm(), slack * exact_U.norm()) << trial;
      EXPECT_LT((gauss.T[v] - exact_T).norm(), slack * exact_T.norm()) << trial;
    }
  }
}

TEST(NearSingularRule, IntegratesLaplaceToo) {
  const Laplace<double> kernel;
  const Vector3d x(0.5, 0.2, 0.25);
  double U = 0, T = 0;
  NearSingularRule(triangle, x, 1e-13).for_each([&](const Vector3d& r, const Vector3d& hats, double weight) {
    U += weight * hats[1] * kernel.single_layer(r)(0, 0);
    T += weight * hats[1] * kernel.double_layer(r, Vector3d::UnitZ())(0, 0);
  });
  EXPECT_NEAR(U, kernel.single_layer_integral(single_layer_moments(triangle, x)[1])(0, 0), tolerance::rounding);
  EXPECT_NEAR(T, kernel.double_layer_integral(double_layer_moments(triangle, x)[1], triangle.normal)(0, 0),
              tolerance::rounding);
}

TEST(NearSingularRule, DoesNotDependOnTheUnitOfLength) {
  for (double scale : {0x1p-10, 0x1p10, 0x1p-100, 0x1p100}) {
    const TriangleGeometry<double> scaled(scale * v0, scale * v1, scale * v2);
    const Vector3d x(0.5, 0.2, 0.25);
    const auto here = near_singular_blocks(triangle, x, 0.3, 1e-9);
    const auto there = near_singular_blocks(scaled, scale * x, 0.3, 1e-9);
    for (int v = 0; v < 3; ++v) {
      EXPECT_EQ(here.T[v], there.T[v]);
      EXPECT_EQ(scale * here.U[v], there.U[v]);
    }
  }
}

TEST(NearSingularRule, IsFiniteAtTheSmallestDistancesAndForTheFlattestTriangles) {
  const TriangleGeometry<double> needle({0, 0, 0}, {1, 0, 0}, {0.3, 1e-6, 0});
  for (const auto* t : {&triangle, &needle}) {
    for (double distance : {1e-3, 1e-16, 1e-100, 1e-300, std::numeric_limits<double>::denorm_min(), 0.0}) {
      for (const Vector3d& base :
           {t->vertices[0], Vector3d(0.5 * (t->vertices[0] + t->vertices[1])), Vector3d(Vector3d::Zero())}) {
        const Vector3d x = base + distance * t->normal;
        const auto blocks = near_singular_blocks(*t, x, 0.3, 1e-10);
        for (int v = 0; v < 3; ++v) {
          EXPECT_TRUE(blocks.U[v].allFinite()) << distance;
          EXPECT_TRUE(blocks.T[v].allFinite()) << distance;
        }
      }
    }
  }
}

TEST(NearSingularRule, RefusesTrianglesWithoutAreaAndPointsThatAreNotFinite) {
  const TriangleGeometry<double> line({0, 0, 0}, {1, 0, 0}, {2, 0, 0}), point({1, 1, 1}, {1, 1, 1}, {1, 1, 1});
  const double infinity = std::numeric_limits<double>::infinity(), nan = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(NearSingularRule(line, {0, 1, 0}, 1e-8), std::invalid_argument);
  EXPECT_THROW(NearSingularRule(point, {0, 1, 0}, 1e-8), std::invalid_argument);
  EXPECT_THROW(NearSingularRule(triangle, {0, infinity, 0}, 1e-8), std::invalid_argument);
  EXPECT_THROW(NearSingularRule(triangle, {0, nan, 0}, 1e-8), std::invalid_argument);
  EXPECT_THROW(NearSingularRule(TriangleGeometry<double>(1e-60 * v0, 1e-60 * v1, 1e-60 * v2), {0, 0, 0}, 1e-8),
               std::invalid_argument);
}

}  // namespace
}  // namespace skinbem
