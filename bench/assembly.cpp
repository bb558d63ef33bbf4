// SPDX-License-Identifier: BSD-3-Clause
// Assembly of H (arguments: vertices, digits of the tolerance, threads) and of a landmark's three columns of G.
// Counters: vertex-triangle pairs a second, share of pairs that are near.
#include <benchmark/benchmark.h>
#include <omp.h>

#include <skinbem/operator/collocation.hpp>

#include "bodies.hpp"

namespace {

using namespace skinbem;

QuadratureOptions digits(std::int64_t n) { return {std::pow(10.0, -static_cast<double>(n))}; }

void double_layer(benchmark::State& state) {
  const int threads = omp_get_max_threads();
  omp_set_num_threads(static_cast<int>(state.range(2)));
  const Collocation<Kelvin<double>> collocation(benchmarks::leg_like_of(state.range(0)), {}, digits(state.range(1)));
  AssemblyCounts counts;
  for (auto _ : state) {
    counts = {};
    benchmark::DoNotOptimize(collocation.double_layer_matrix({}, &counts));
  }
  omp_set_num_threads(threads);
  state.counters["pairs/s"] = benchmark::Counter(
      static_cast<double>(counts.pairs) * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
  state.counters["near"] = static_cast<double>(counts.near) / static_cast<double>(counts.pairs);
}
BENCHMARK(double_layer)
    ->ArgsProduct({{600}, {4, 6, 8, 12}, {1, 2}})
    ->Args({2000, 8, 2})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

void landmark_columns(benchmark::State& state) {
  const Collocation<Kelvin<double>> collocation(benchmarks::leg_like_of(state.range(0)), {}, digits(8));
  const VertexWeight hat{0, 1.0};
  for (auto _ : state) benchmark::DoNotOptimize(collocation.single_layer_columns(std::span(&hat, 1)));
}
BENCHMARK(landmark_columns)->Arg(600)->Arg(2000)->Unit(benchmark::kMicrosecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
