// SPDX-License-Identifier: BSD-3-Clause
// The closed form of the element integrals against plain adaptive Gauss in long double.
#include <gtest/gtest.h>

#include <skinbem/kernels/kelvin.hpp>
#include <skinbem/operator/element_integral.hpp>

#include "adaptive_gauss.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using testing_support::integrate_adaptively;
using testing_support::LongBlock;
using testing_support::LongVector;

struct Shape {
  const char* name;
  std::array<Eigen::Vector3d, 3> vertices;
};

const Shape kShapes[] = {
    {"equilateral", {{{0, 0, 0}, {1, 0, 0}, {0.5, 0.8660254037844386, 0}}}},
    {"right", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}},
    {"needle", {{{0, 0, 0}, {1, 0, 0}, {0.4, 0.03, 0}}}},
    {"turned", {{{0.3, -0.2, 0.1}, {-0.5, 0.4, 0.7}, {0.2, 0.9, -0.3}}}},
};

/// Largest difference of any block, relative to the largest entry of the three blocks.
double difference(const std::array<Eigen::Matrix3d, 3>& a, const std::array<LongBlock, 3>& b) {
  long double worst = 0, largest = 0;
  for (int v = 0; v < 3; ++v) {
    worst = std::max(worst, (a[v].cast<long double>() - b[v]).cwiseAbs().maxCoeff());
    largest = std::max(largest, b[v].cwiseAbs().maxCoeff());
  }
  return double(worst / largest);
}

class ClosedForm : public ::testing::TestWithParam<double> {
 protected:
  Kelvin<double> kernel_{GetParam(), 1.0};
  Kelvin<long double> exact_{GetParam(), 1.0L};

  double single_layer_error(const Shape& s, const Eigen::Vector3d& x) const {
    const TriangleGeometry<double> g(s.vertices[0], s.vertices[1], s.vertices[2]);
    const auto m = single_layer_moments(g, x);
    return difference(
        {kernel_.single_layer_integral(m[0]), kernel_.single_layer_integral(m[1]), kernel_.single_layer_integral(m[2])},
        integrate_adaptively(s.vertices, x, [&](const LongVector& r) { return exact_.single_layer(r); }));
  }

  /// Leaves out the hat function of vertex `without`.
  double double_layer_error(const Shape& s, const Eigen::Vector3d& x, int without = -1) const {
    const TriangleGeometry<double> g(s.vertices[0], s.vertices[1], s.vertices[2]);
    const TriangleGeometry<long double> exact_geometry(
        s.vertices[0].cast<long double>(), s.vertices[1].cast<long double>(), s.vertices[2].cast<long double>());
    const auto m = double_layer_moments(g, x);
    std::array<Eigen::Matrix3d, 3> blocks;
    for (int v = 0; v < 3; ++v) blocks[v] = kernel_.double_layer_integral(m[v], g.normal);
    auto expected = integrate_adaptively(
        s.vertices, x, [&](const LongVector& r) { return exact_.double_layer(r, exact_geometry.normal); });
    if (without >= 0) {
      blocks[without].setZero();
      expected[without].setZero();
    }
    return difference(blocks, expected);
  }
};

TEST_P(ClosedForm, EqualsAdaptiveGaussAboveBesideAndInThePlane) {
  for (const Shape& s : kShapes) {
    const auto& v = s.vertices;
    const Eigen::Vector3d n = (v[1] - v[0]).cross(v[2] - v[0]).normalized();
    const Eigen::Vector3d inside = 0.3 * v[0] + 0.3 * v[1] + 0.4 * v[2], edge = (v[0] + v[1]) / 2;
    const Eigen::Vector3d outward = (v[1] - v[0]).cross(n).normalized();
    for (const double d : {1e-4, 1e-2, 0.3, 1.0}) {
      for (const Eigen::Vector3d& x : {Eigen::Vector3d(inside + d * n), Eigen::Vector3d(inside - d * n),
                                       Eigen::Vector3d(edge + d * n), Eigen::Vector3d(edge + d * outward),
                                       Eigen::Vector3d(v[2] + d * n), Eigen::Vector3d(v[1] + d * (v[1] - v[0]))}) {
        EXPECT_LE(single_layer_error(s, x), tolerance::closed_form_against_gauss)
            << s.name << ' ' << d << ' ' << x.transpose();
        EXPECT_LE(double_layer_error(s, x), tolerance::closed_form_against_gauss)
            << s.name << ' ' << d << ' ' << x.transpose();
      }
    }
  }
}

TEST_P(ClosedForm, EqualsAdaptiveGaussAtAVertex) {
  for (const Shape& s : kShapes) {
    for (int v = 0; v < 3; ++v) {
      EXPECT_LE(single_layer_error(s, s.vertices[v]), tolerance::closed_form_against_gauss) << s.name << ' ' << v;
      EXPECT_LE(double_layer_error(s, s.vertices[v], v), tolerance::closed_form_against_gauss) << s.name << ' ' << v;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(Poisson, ClosedForm, ::testing::Values(-0.5, 0.3, 0.49));

TEST(ElementIntegral, MeetsItsToleranceAtAnyDistanceFromNeedlesAndCaps) {
  const Shape slender[] = {
      {"needle 1:300", {{{0, 0, 0}, {1, 0, 0}, {1, 0.0033, 0}}}},
      {"cap 1:100", {{{0, 0, 0}, {1, 0, 0}, {0.45, 0.01, 0}}}},
  };
  const Kelvin<double> kernel{0.3, 1.0};
  const Kelvin<long double> exact{0.3L, 1.0L};
  const Eigen::Vector3d direction = Eigen::Vector3d(0.3, 0.8, 0.5).normalized();
  for (const Shape& s : slender) {
    const SourceTriangle t(s.vertices[0], s.vertices[1], s.vertices[2]);
    const LongVector n = t.geometry.normal.cast<long double>();
    for (const double d : {1e-3, 0.05, 0.3, 0.7, 10.0}) {
      const Eigen::Vector3d x = t.centroid + d * direction;
      const auto U = integrate_adaptively(s.vertices, x, [&](const LongVector& r) { return exact.single_layer(r); });
      const auto T = integrate_adaptively(s.vertices, x, [&](const LongVector& r) { return exact.double_layer(r, n); });
      for (const double requested : {1e-4, 1e-8, 1e-12}) {
        const ElementIntegral<Kelvin<double>> integral(kernel, requested);
        const double allowed = std::max(requested, tolerance::closed_form_against_gauss);
        EXPECT_LE(difference(integral.single_layer(t, x), U), allowed) << s.name << ' ' << d << ' ' << requested;
        EXPECT_LE(difference(integral.double_layer(t, x), T), allowed) << s.name << ' ' << d << ' ' << requested;
      }
    }
  }
}

}  // namespace
}  // namespace skinbem
