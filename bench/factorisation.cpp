// SPDX-License-Identifier: BSD-3-Clause
// Dense (H + B B^T)^-1: factorisation in single precision, and 18 right-hand sides refined to the tolerance (arguments:
// vertices, digits). Counter: floating-point operations a second, 2/3 n^3 of a factorisation.
#include <benchmark/benchmark.h>

#include <skinbem/operator/collocation.hpp>
#include <skinbem/solve/neumann_solver.hpp>
#include <skinbem/solve/rigid_modes.hpp>

#include "bodies.hpp"

namespace {

using namespace skinbem;

auto assembled(const TriangleMesh& mesh) { return Collocation<Kelvin<double>>(mesh, {}, {1e-8}).double_layer_matrix(); }

void factorise(benchmark::State& state) {
  const TriangleMesh mesh = benchmarks::leg_like_of(state.range(0));
  const auto H = assembled(mesh);
  const Eigen::MatrixXd B = rigid_modes(mesh.vertices);
  for (auto _ : state) benchmark::DoNotOptimize(make_dense_solver(H, B, 1e-8));
  const double n = static_cast<double>(H.rows());
  state.counters["flop/s"] =
      benchmark::Counter(2.0 / 3.0 * n * n * n * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}
BENCHMARK(factorise)->Arg(600)->Arg(1500)->Unit(benchmark::kMillisecond)->UseRealTime();

void solve(benchmark::State& state) {
  const TriangleMesh mesh = benchmarks::leg_like_of(state.range(0));
  const Eigen::MatrixXd B = rigid_modes(mesh.vertices);
  const auto solver = make_dense_solver(assembled(mesh), B, std::pow(10.0, -static_cast<double>(state.range(1))));
  const Eigen::MatrixXd G = Eigen::MatrixXd::Random(B.rows(), 18);
  SolveSummary summary;
  for (auto _ : state) benchmark::DoNotOptimize(solver->solve(G, &summary));
  state.counters["refinements"] = summary.iterations;
  state.counters["residual"] = summary.residual;
}
BENCHMARK(solve)->ArgsProduct({{600}, {6, 8, 12}})->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
