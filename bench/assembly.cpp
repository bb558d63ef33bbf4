// SPDX-License-Identifier: BSD-3-Clause
// Assembly of H (arguments: vertices, digits of the tolerance, threads), of a block of H far from the diagonal (rows,
// columns, digits; one thread), and of a landmark's three columns of G. Counters: vertex-triangle pairs a second, share
// of pairs that are near.
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
    ->ArgsProduct({{2000}, {8}, {1, 2}})
    ->Unit(benchmark::kMillisecond)
    ->UseRealTime();

/// Rows at the foot of a leg of 10,000 vertices, every so many of them, columns next to each other on its upper half.
void far_block(benchmark::State& state) {
  const TriangleMesh mesh = benchmarks::leg_like_of(10000);
  const Collocation<Kelvin<double>> collocation(mesh, {}, digits(state.range(2)));
  std::vector<std::int32_t> foot, head;
  for (std::int32_t v = 0; v < mesh.vertex_count(); ++v) {
    if (mesh.vertices(v, 2) < -60) foot.push_back(v);
    if (mesh.vertices(v, 2) > 60) head.push_back(v);
  }
  std::vector<std::int32_t> rows, columns(head.begin(), head.begin() + state.range(1));
  for (std::int64_t r = 0; r < state.range(0); ++r) rows.push_back(foot[foot.size() * r / state.range(0)]);
  std::vector<char> is_column(mesh.vertex_count(), 0);
  for (const std::int32_t v : columns) is_column[v] = 1;
  Index triangles = 0;
  for (Index t = 0; t < mesh.triangle_count(); ++t)
    triangles += is_column[mesh.triangles(t, 0)] || is_column[mesh.triangles(t, 1)] || is_column[mesh.triangles(t, 2)];
  Eigen::MatrixXd block(3 * rows.size(), 3 * columns.size());
  for (auto _ : state) {
    collocation.double_layer_block(rows, columns, block);
    benchmark::DoNotOptimize(block.data());
  }
  state.counters["pairs/s"] = benchmark::Counter(static_cast<double>(state.iterations() * state.range(0) * triangles),
                                                 benchmark::Counter::kIsRate);
}
BENCHMARK(far_block)
    ->ArgsProduct({{256}, {256}, {5, 6, 8}})
    ->Args({16, 3000, 6})
    ->Args({3000, 4, 6})
    ->Unit(benchmark::kMicrosecond);

void landmark_columns(benchmark::State& state) {
  const Collocation<Kelvin<double>> collocation(benchmarks::leg_like_of(state.range(0)), {}, digits(8));
  const VertexWeight hat{0, 1.0};
  for (auto _ : state) benchmark::DoNotOptimize(collocation.single_layer_columns(std::span(&hat, 1)));
}
BENCHMARK(landmark_columns)->Arg(600)->Arg(2000)->Unit(benchmark::kMicrosecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
