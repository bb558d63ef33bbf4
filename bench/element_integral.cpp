// SPDX-License-Identifier: BSD-3-Clause
// One triangle, one field point, three hat functions: by the closed form (near) and by the Gauss rule that each
// tolerance asks for at a distance (far), one point at a time. The operator takes far points by the panel (assembly).
#include <benchmark/benchmark.h>

#include <skinbem/kernels/kelvin.hpp>
#include <skinbem/operator/element_integral.hpp>

namespace {

using namespace skinbem;

const SourceTriangle kTriangle({0, 0, 0}, {1, 0.1, 0}, {0.4, 0.9, 0.1});

/// Points at `distance` radii from the centroid, in turn.
std::array<Eigen::Vector3d, 16> points_at(double distance) {
  std::array<Eigen::Vector3d, 16> points;
  for (std::size_t k = 0; k < points.size(); ++k) {
    const double angle = 0.4 * static_cast<double>(k);
    const Eigen::Vector3d direction = Eigen::Vector3d(std::cos(angle), std::sin(angle), 0.7).normalized();
    points[k] = kTriangle.centroid + distance * std::sqrt(kTriangle.radius2) * direction;
  }
  return points;
}

void double_layer(benchmark::State& state) {
  const ElementIntegral<Kelvin<double>> integral({}, std::pow(10.0, -static_cast<double>(state.range(1))));
  const auto points = points_at(static_cast<double>(state.range(0)) / 10);
  std::size_t k = 0;
  for (auto _ : state) benchmark::DoNotOptimize(integral.double_layer(kTriangle, points[k++ % points.size()]));
  const auto* rule = integral.double_layer_rules().rule(std::pow(static_cast<double>(state.range(0)) / 10, 2));
  state.SetLabel(rule ? std::to_string(rule->size()) + " points" : "closed form");
}

void single_layer(benchmark::State& state) {
  const ElementIntegral<Kelvin<double>> integral({}, std::pow(10.0, -static_cast<double>(state.range(1))));
  const auto points = points_at(static_cast<double>(state.range(0)) / 10);
  std::size_t k = 0;
  for (auto _ : state) benchmark::DoNotOptimize(integral.single_layer(kTriangle, points[k++ % points.size()]));
  const auto* rule = integral.single_layer_rules().rule(std::pow(static_cast<double>(state.range(0)) / 10, 2));
  state.SetLabel(rule ? std::to_string(rule->size()) + " points" : "closed form");
}

/// Distance in tenths of the triangle's radius; digits.
void distances(benchmark::internal::Benchmark* benchmark) {
  for (const int distance : {5, 20, 50, 200}) {
    for (const int digits : {4, 8, 12}) benchmark->Args({distance, digits});
  }
}
BENCHMARK(double_layer)->Apply(distances);
BENCHMARK(single_layer)->Apply(distances);

}  // namespace

BENCHMARK_MAIN();
