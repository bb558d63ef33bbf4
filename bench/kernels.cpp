// SPDX-License-Identifier: BSD-3-Clause
// Kelvin's kernels for a panel of points against Gauss points: time per point pair (all nine entries, against three hat
// functions for T, their sum for U), in SIMD and by the scalar template. Counters: pairs a second, floating-point
// operations a second as written in kelvin_batch.cpp (a fused multiply-add is two).
#include <benchmark/benchmark.h>

#include <array>
#include <random>
#include <vector>

#include <skinbem/kernels/kelvin_batch.hpp>

namespace {

using namespace skinbem;

/// A kernel without a batch: the scalar template serves.
struct ScalarKelvin : Kelvin<double> {};

struct Scene {
  explicit Scene(std::size_t gauss_points) {
    std::mt19937 random(1);
    std::uniform_real_distribution<double> uniform(0, 1);
    for (auto* values : {&x, &y, &a, &b, &c}) {
      values->resize(gauss_points);
      for (double& v : *values) v = uniform(random);
    }
    z.assign(gauss_points, 0.0);
    for (std::size_t p = 0; p < kPanel; ++p) {
      panel.x[p] = 5 + uniform(random);
      panel.y[p] = uniform(random);
      panel.z[p] = 2 + uniform(random);
    }
  }
  SourcePoints source() const { return {x.size(), x.data(), y.data(), z.data(), {a.data(), b.data(), c.data()}}; }

  PointPanel panel;
  std::vector<double> x, y, z, a, b, c;
};

template <class Real = double>
struct alignas(64) Entries {
  std::array<Real, 9 * kPanel> values{};
};

void count(benchmark::State& state, double operations_per_pair) {
  const double pairs = static_cast<double>(state.iterations()) * static_cast<double>(state.range(0)) * kPanel;
  state.counters["pairs/s"] = benchmark::Counter(pairs, benchmark::Counter::kIsRate);
  state.counters["ns/pair"] =
      benchmark::Counter(pairs * 1e-9, benchmark::Counter::kIsRate | benchmark::Counter::kInvert);
  state.counters["flop/s"] = benchmark::Counter(pairs * operations_per_pair, benchmark::Counter::kIsRate);
}

template <class Kernel, class Real = double>
void double_layer(benchmark::State& state) {
  const Kernel kernel{};
  const Scene scene(static_cast<std::size_t>(state.range(0)));
  Entries<Real> out[3];
  Real* const pointers[3] = {out[0].values.data(), out[1].values.data(), out[2].values.data()};
  for (auto _ : state) {
    add_double_layer(kernel, scene.panel, 0xffffu, scene.source(), Eigen::Vector3d::UnitZ(), pointers);
    benchmark::ClobberMemory();
  }
  count(state, 3 + 5 + 15 + 2 + 3 + 2 + 1 + 6 + 54);
}
BENCHMARK(double_layer<Kelvin<double>>)->Arg(3)->Arg(7)->Arg(16)->Arg(42);
BENCHMARK((double_layer<Kelvin<double>, float>))->Arg(3)->Arg(7)->Arg(16)->Arg(42);
BENCHMARK(double_layer<ScalarKelvin>)->Arg(7);

template <class Kernel>
void single_layer(benchmark::State& state) {
  const Kernel kernel{};
  const Scene scene(static_cast<std::size_t>(state.range(0)));
  Entries<> out;
  for (auto _ : state) {
    add_single_layer(kernel, scene.panel, 0xffffu, scene.source(), out.values.data());
    benchmark::ClobberMemory();
  }
  count(state, 3 + 5 + 15 + 3 + 3 + 12);
}
BENCHMARK(single_layer<Kelvin<double>>)->Arg(3)->Arg(7)->Arg(16)->Arg(42);
BENCHMARK(single_layer<ScalarKelvin>)->Arg(7);

}  // namespace

int main(int argc, char** argv) {
  benchmark::Initialize(&argc, argv);
  benchmark::AddCustomContext("instruction set", skinbem::instruction_set());
  benchmark::RunSpecifiedBenchmarks();
}
