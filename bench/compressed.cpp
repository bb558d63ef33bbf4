// SPDX-License-Identifier: BSD-3-Clause
// The compressed double layer of the limb with 9,666 vertices: how long it takes to build, and its product with 18
// columns, as the iteration makes it, on one and two threads (the argument). `share` is that of the smaller limit: what
// sgemm computes and memory delivers to as many threads, measured in the same run, the best of each.
#include <benchmark/benchmark.h>
#include <cblas.h>
#include <omp.h>

#include <algorithm>
#include <limits>

#include <skinbem/base/stopwatch.hpp>
#include <skinbem/hmatrix/compressed_matrix.hpp>
#include <skinbem/mesh/mesh_io.hpp>
#include <skinbem/solve/neumann_solver.hpp>

#include "read_bandwidth.hpp"
#include "subdivision.hpp"

extern "C" void openblas_set_num_threads(int);

namespace {

using namespace skinbem;
using Matrix = CompressedMatrix<float>;

constexpr Index kColumns = 18;
constexpr double kTolerance = 2e-4;

struct Limits {
  double flops = 0, bytes = 0;  ///< a second
};

/// Work done in a second on all threads, the best of some runs; `work(thread)` returns how much it did.
template <class Work>
double best_rate(int threads, const Work& work) {
  double best = 0;
  for (int run = 0; run < 20; ++run) {
    Stopwatch watch;
    double done = 0;
#pragma omp parallel for num_threads(threads) schedule(static, 1) reduction(+ : done)
    for (int thread = 0; thread < threads; ++thread) done += work(thread);
    best = std::max(best, done / watch.lap());
  }
  return best;
}

/// Square products of 768, and reading 256 MB from memory in the faster of two ways.
Limits limits_of(int threads) {
  constexpr int n = 768;
  constexpr std::size_t floats = std::size_t{64} << 20;
  openblas_set_num_threads(1);
  const Eigen::MatrixXf A = Eigen::MatrixXf::Random(n, n);
  std::vector<Eigen::MatrixXf> products(static_cast<std::size_t>(threads), Eigen::MatrixXf::Zero(n, n));
  const double flops = best_rate(threads, [&](int thread) {
    cblas_sgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, n, n, n, 1, A.data(), n, A.data(), n, 0,
                products[static_cast<std::size_t>(thread)].data(), n);
    return 2.0 * n * n * n;
  });
  const detail::AlignedVector<float> buffer(floats, 1.0F);
  const auto reading = [&](auto& read) {
    return best_rate(threads, [&](int thread) {
      const std::size_t share = floats / static_cast<std::size_t>(threads);
      benchmark::DoNotOptimize(read(buffer.data() + static_cast<std::size_t>(thread) * share, share));
      return static_cast<double>(share * sizeof(float));
    });
  };
  return {flops, std::max(reading(bench::read_stream), reading(bench::read_in_turns))};
}

const TriangleMesh& limb() {
  static const TriangleMesh mesh = bench::smooth_refinements(read_mesh(SKINBEM_LOWER_LIMB "/skin.obj"), 2).back();
  return mesh;
}

Matrix compressed_limb() {
  const Collocation<Kelvin<double>> collocation(limb(), {}, {kTolerance});
  return {limb(), collocation, IterativeOptions::for_tolerance(kTolerance, limb().vertex_count()).compression};
}

void build(benchmark::State& state) {
  omp_set_num_threads(static_cast<int>(state.range(0)));
  CompressionSummary s;
  for (auto _ : state) s = compressed_limb().summary();
  state.counters["basis_s"] = s.basis_seconds;
  state.counters["near_s"] = s.near_seconds;
  state.counters["near_MB"] = 1e-6 * static_cast<double>(s.near_bytes);
  state.counters["coupling_Mnumbers"] = 1e-6 * static_cast<double>(s.coupling_numbers);
  state.counters["basis_MB"] = 1e-6 * static_cast<double>(s.basis_bytes);
  state.counters["rank"] = s.mean_rank;
}
BENCHMARK(build)->Arg(1)->Arg(2)->Iterations(1)->Unit(benchmark::kMillisecond)->UseRealTime();

void product(benchmark::State& state) {
  const int threads = static_cast<int>(state.range(0));
  const Limits limits = limits_of(threads);
  omp_set_num_threads(threads);
  static const Matrix H = compressed_limb();
  const VectorBlock X = VectorBlock::Random(H.rows(), kColumns);
  VectorBlock Y;
  Matrix::Block work;
  H.multiply(X, Y, work);
  double seconds = std::numeric_limits<double>::infinity();  // the best, as of the limits
  for (auto _ : state) {
    Stopwatch watch;
    H.multiply(X, Y, work);
    seconds = std::min(seconds, watch.lap());
  }
  const double bytes = static_cast<double>(H.bytes()), flops = 2.0 * kColumns * static_cast<double>(H.numbers());
  state.counters["GF/s"] = 1e-9 * flops / seconds;
  state.counters["GB/s"] = 1e-9 * bytes / seconds;
  state.counters["sgemm_GF/s"] = 1e-9 * limits.flops;
  state.counters["read_GB/s"] = 1e-9 * limits.bytes;
  state.counters["share"] = std::max(flops / limits.flops, bytes / limits.bytes) / seconds;
}
BENCHMARK(product)->Arg(1)->Arg(2)->MinTime(1)->Unit(benchmark::kMillisecond)->UseRealTime();

}  // namespace

BENCHMARK_MAIN();
