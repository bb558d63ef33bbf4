// SPDX-License-Identifier: BSD-3-Clause
// The SIMD panels against the scalar template of panel.hpp.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <random>
#include <skinbem/kernels/kelvin_batch.hpp>
#include <vector>

#include "tolerances.hpp"

namespace skinbem {
namespace {

/// A kernel that has no batch of its own: calls go to the template.
struct ScalarKelvin : Kelvin<double> {};

constexpr std::size_t kGaussPoints = 7;

/// A panel of points around a triangle in the plane with normal n, and Gauss points on it.
struct Scene {
  PointPanel panel;
  std::array<double, kGaussPoints> x, y, z, weights[3];
  Eigen::Vector3d normal;

  explicit Scene(unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> uniform(-1, 1);
    normal = Eigen::Vector3d(uniform(random), uniform(random), 1.5).normalized();
    const Eigen::Vector3d first = normal.unitOrthogonal(), second = normal.cross(first);
    for (std::size_t q = 0; q < kGaussPoints; ++q) {
      const Eigen::Vector3d p = 0.2 * (uniform(random) * first + uniform(random) * second);
      x[q] = p[0];
      y[q] = p[1];
      z[q] = p[2];
      for (auto& w : weights) w[q] = std::abs(uniform(random));
    }
    for (std::size_t p = 0; p < kPanel; ++p) {
      const Eigen::Vector3d away = Eigen::Vector3d(uniform(random), uniform(random), uniform(random)).normalized();
      const Eigen::Vector3d point = away * std::pow(10, 1 + uniform(random));
      panel.x[p] = point[0];
      panel.y[p] = point[1];
      panel.z[p] = point[2];
    }
  }
  SourcePoints source() const {
    return {kGaussPoints, x.data(), y.data(), z.data(), {weights[0].data(), weights[1].data(), weights[2].data()}};
  }
};

/// Entries of 16 points. Each batch is called twice, since it must add.
template <class Real>
struct alignas(64) EntriesIn {
  std::array<Real, 9 * kPanel> values{};
};
using Entries = EntriesIn<double>;

template <class Real>
void expect_same(const EntriesIn<Real>& simd, const Entries& scalar, PanelMask mask,
                 double allowed = tolerance::batch) {
  for (std::size_t p = 0; p < kPanel; ++p) {
    double largest = 0;
    for (std::size_t e = 0; e < 9; ++e) largest = std::max(largest, std::abs(scalar.values[e * kPanel + p]));
    for (std::size_t e = 0; e < 9; ++e) {
      const double a = simd.values[e * kPanel + p], b = scalar.values[e * kPanel + p];
      if ((mask >> p & 1u) == 0) {
        ASSERT_EQ(a, 0) << "touched a point that is not in the mask";
      } else {
        ASSERT_LE(std::abs(a - b), allowed * largest) << mask << ' ' << p << ' ' << e;
      }
    }
  }
}

class KelvinPanel : public ::testing::TestWithParam<double> {
 protected:
  Kelvin<double> batch_{GetParam(), 1.5};
  ScalarKelvin scalar_{{GetParam(), 1.5}};
};

TEST_P(KelvinPanel, DoubleLayerEqualsTheScalarKernelForEveryMask) {
  const Scene scene(1);
  for (PanelMask mask = 0; mask < 1u << kPanel; mask += mask < 256 ? 1 : 251) {
    Entries a[3], b[3];
    double* const out_a[3] = {a[0].values.data(), a[1].values.data(), a[2].values.data()};
    double* const out_b[3] = {b[0].values.data(), b[1].values.data(), b[2].values.data()};
    for (int twice = 0; twice < 2; ++twice) {
      add_double_layer(batch_, scene.panel, mask, scene.source(), scene.normal, out_a);
      add_double_layer(scalar_, scene.panel, mask, scene.source(), scene.normal, out_b);
    }
    for (int v = 0; v < 3; ++v) expect_same(a[v], b[v], mask);
  }
}

TEST_P(KelvinPanel, DoubleLayerInSinglePrecisionStaysWithinItsError) {
  const Scene scene(3);
  for (PanelMask mask = 0; mask < 1u << kPanel; mask += mask < 256 ? 1 : 251) {
    EntriesIn<float> a[3], c[3];
    Entries b[3];
    float* const out_a[3] = {a[0].values.data(), a[1].values.data(), a[2].values.data()};
    double* const out_b[3] = {b[0].values.data(), b[1].values.data(), b[2].values.data()};
    float* const out_c[3] = {c[0].values.data(), c[1].values.data(), c[2].values.data()};
    for (int twice = 0; twice < 2; ++twice) {
      add_double_layer(batch_, scene.panel, mask, scene.source(), scene.normal, out_a);
      add_double_layer(scalar_, scene.panel, mask, scene.source(), scene.normal, out_b);
      add_double_layer(scalar_, scene.panel, mask, scene.source(), scene.normal, out_c);
    }
    for (int v = 0; v < 3; ++v) {
      expect_same(a[v], b[v], mask, tolerance::single_precision_batch);
      expect_same(c[v], b[v], mask, tolerance::single_precision_batch);
    }
  }
}

TEST_P(KelvinPanel, RulesOfAnyLengthAreTakenInSinglePrecision) {
  constexpr std::size_t count = 150;
  const Scene scene(5);
  std::array<double, count> x, y, z, weights;
  for (std::size_t q = 0; q < count; ++q) {
    x[q] = scene.x[q % kGaussPoints];
    y[q] = scene.y[q % kGaussPoints];
    z[q] = scene.z[q % kGaussPoints];
    weights[q] = 1.0 / double(count);
  }
  const SourcePoints source{count, x.data(), y.data(), z.data(), {weights.data(), weights.data(), weights.data()}};
  EntriesIn<float> a[3];
  Entries b[3];
  float* const out_a[3] = {a[0].values.data(), a[1].values.data(), a[2].values.data()};
  double* const out_b[3] = {b[0].values.data(), b[1].values.data(), b[2].values.data()};
  const PanelMask all = (1u << kPanel) - 1;
  add_double_layer(batch_, scene.panel, all, source, scene.normal, out_a);
  add_double_layer(scalar_, scene.panel, all, source, scene.normal, out_b);
  for (int v = 0; v < 3; ++v) expect_same(a[v], b[v], all, tolerance::single_precision_batch);
}

TEST_P(KelvinPanel, SingleLayerEqualsTheScalarKernelForEveryMask) {
  const Scene scene(2);
  for (PanelMask mask = 0; mask < 1u << kPanel; mask += mask < 256 ? 1 : 251) {
    Entries a, b;
    for (int twice = 0; twice < 2; ++twice) {
      add_single_layer(batch_, scene.panel, mask, scene.source(), a.values.data());
      add_single_layer(scalar_, scene.panel, mask, scene.source(), b.values.data());
    }
    expect_same(a, b, mask);
  }
}

TEST_P(KelvinPanel, DipolesEqualTheScalarKernel) {
  const Scene scene(4);
  std::array<double, kGaussPoints> normal[3];
  for (std::size_t q = 0; q < kGaussPoints; ++q) {
    const Eigen::Vector3d n = Eigen::Vector3d(0.1 * double(q), 1, -0.3 * double(q)).normalized();
    for (int k = 0; k < 3; ++k) normal[k][q] = n[k];
  }
  for (const std::size_t count : {kGaussPoints, std::size_t{1}, std::size_t{0}}) {
    const Dipoles dipoles{
        count, scene.x.data(), scene.y.data(), scene.z.data(), {normal[0].data(), normal[1].data(), normal[2].data()}};
    alignas(64) std::array<Entries, kGaussPoints> a, b;
    double_layer_of_dipoles(batch_, scene.panel, dipoles, a[0].values.data());
    double_layer_of_dipoles(scalar_, scene.panel, dipoles, b[0].values.data());
    for (std::size_t q = 0; q < kGaussPoints; ++q) {
      expect_same(a[q], b[q], q < count ? (1u << kPanel) - 1 : 0);  // what is behind them stays
    }
  }
}

/// Rows of all components near the origin, and dipoles with every set of components some way off.
template <class Real>
struct DipoleScene {
  static constexpr std::size_t kRows = 3 * kPanel, kDipoles = 14, kColumns = 24;
  alignas(64) std::array<Real, kRows> x, y, z, component;
  std::array<Real, kDipoles> dipoles[6];

  DipoleScene() {
    std::mt19937 random(6);
    std::uniform_real_distribution<double> uniform(-1, 1);
    for (auto* coordinate : {&x, &y, &z}) {
      for (Real& value : *coordinate) value = static_cast<Real>(uniform(random));
    }
    for (std::size_t r = 0; r < kRows; ++r) component[r] = static_cast<Real>(random() % 3);
    for (std::size_t q = 0; q < kDipoles; ++q) {
      const Eigen::Vector3d n = Eigen::Vector3d(uniform(random), uniform(random), uniform(random)).normalized();
      for (std::size_t k = 0; k < 3; ++k) {
        dipoles[k][q] = static_cast<Real>(3 + uniform(random));
        dipoles[3 + k][q] = static_cast<Real>(n[Eigen::Index(k)]);
      }
    }
  }
  FieldRows<Real> rows(std::size_t count) const { return {count, x.data(), y.data(), z.data(), component.data()}; }
  DipoleColumns<Real> columns() const {
    return {{0, 2, 2, 2, 2, 2, 2, 2},
            dipoles[0].data(),
            dipoles[1].data(),
            dipoles[2].data(),
            {dipoles[3].data(), dipoles[4].data(), dipoles[5].data()}};
  }
  template <class Kernel>
  std::vector<Real> matrix(const Kernel& kernel, std::size_t count) const {
    alignas(64) std::array<Real, kRows * kColumns> out;
    dipole_matrix(kernel, rows(count), columns(), out.data());
    return {out.begin(), out.begin() + std::ptrdiff_t(count * kColumns)};
  }
};

TEST_P(KelvinPanel, MatricesOfDipolesEqualTheScalarKernel) {
  const auto expect_alike = [&](const auto& scene, double allowed) {
    for (const std::size_t count : {kPanel, 2 * kPanel, 3 * kPanel}) {
      const auto simd = scene.matrix(batch_, count), scalar = scene.matrix(scalar_, count);
      const double largest = std::abs(
          *std::max_element(scalar.begin(), scalar.end(), [](auto a, auto b) { return std::abs(a) < std::abs(b); }));
      for (std::size_t k = 0; k < simd.size(); ++k) {
        ASSERT_NEAR(double(simd[k]), double(scalar[k]), allowed * largest) << count << ' ' << k;
      }
    }
  };
  expect_alike(DipoleScene<double>(), tolerance::batch);
  expect_alike(DipoleScene<float>(), tolerance::single_precision_batch);
}

TEST_P(KelvinPanel, MatricesOfDipolesHaveTheirColumnsInOrder) {
  const DipoleScene<double> scene;
  const std::vector<double> found = scene.matrix(batch_, kPanel);
  std::size_t column = 0;
  for (std::size_t q = 0; q < scene.kDipoles; ++q) {
    const unsigned set = unsigned(q / 2 + 1);
    const auto& d = scene.dipoles;
    for (unsigned j = 0; j < 3; ++j) {
      if (!(set >> j & 1)) continue;
      const Eigen::Vector3d y(d[0][q], d[1][q], d[2][q]), n(d[3][q], d[4][q], d[5][q]);
      for (std::size_t r = 0; r < kPanel; ++r) {
        const auto T = scalar_.double_layer(y - Eigen::Vector3d(scene.x[r], scene.y[r], scene.z[r]), n);
        ASSERT_NEAR(found[column * kPanel + r], T(Eigen::Index(scene.component[r]), j), 1e-14) << q << ' ' << j;
      }
      ++column;
    }
  }
  EXPECT_EQ(column, scene.kColumns);
}

INSTANTIATE_TEST_SUITE_P(Poisson, KelvinPanel, ::testing::Values(-0.5, 0.0, 0.3, 0.45, 0.5));

}  // namespace
}  // namespace skinbem
