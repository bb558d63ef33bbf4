// SPDX-License-Identifier: BSD-3-Clause
// From mesh and six landmarks to R (arguments: vertices, digits of the tolerance; counters: milliseconds of each
// stage), and one edit of a landmark with the new R.
#include <benchmark/benchmark.h>

#include <skinbem/response/response_model.hpp>

#include "bodies.hpp"

namespace {

using namespace skinbem;

std::vector<Landmark> six_landmarks(const TriangleMesh& mesh) {
  std::vector<Landmark> landmarks(6);
  for (std::size_t k = 0; k < 6; ++k) {
    landmarks[k].name = std::to_string(k);
    landmarks[k].vertex = static_cast<std::int32_t>((2 * static_cast<Index>(k) + 1) * mesh.vertex_count() / 13);
  }
  return landmarks;
}

ResponseOptions digits(std::int64_t n) { return {0.45, std::pow(10.0, -static_cast<double>(n)), {}}; }

void response(benchmark::State& state) {
  const TriangleMesh mesh = benchmarks::leg_like_of(state.range(0));
  const auto landmarks = six_landmarks(mesh);
  ResponseSummary sum;
  for (auto _ : state) {
    ResponseModel model(mesh, digits(state.range(1)));
    model.add(landmarks);
    benchmark::DoNotOptimize(model.response());
    sum.assemble_seconds += model.summary().assemble_seconds;
    sum.factor_seconds += model.summary().factor_seconds;
    sum.solve_seconds += model.summary().solve_seconds;
  }
  const auto milliseconds = [](double seconds) {
    return benchmark::Counter(seconds * 1e3, benchmark::Counter::kAvgIterations);
  };
  state.counters["assemble_ms"] = milliseconds(sum.assemble_seconds);
  state.counters["factor_ms"] = milliseconds(sum.factor_seconds);
  state.counters["solve_ms"] = milliseconds(sum.solve_seconds);
}
BENCHMARK(response)->Args({600, 3})->Args({600, 6})->Args({600, 10})->Unit(benchmark::kMillisecond)->UseRealTime();

void move_a_landmark(benchmark::State& state) {
  const TriangleMesh mesh = benchmarks::leg_like_of(state.range(0));
  ResponseModel model(mesh, digits(6));
  const auto landmarks = six_landmarks(mesh);
  model.add(landmarks);
  Landmark moved = landmarks[0];
  for (auto _ : state) {
    moved.vertex ^= 1;
    model.move(0, moved);
    benchmark::DoNotOptimize(model.response());
  }
}
BENCHMARK(move_a_landmark)->Arg(600)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
