// SPDX-License-Identifier: BSD-3-Clause
// A frame: rest position + R q, then the rigid motion, for skins of 606 to 50,000 vertices and six landmarks, alone and
// in batches (these of up to 100 landmarks). Beside it Eigen and OpenBLAS do the same product on the same numbers
// (y = x + R q; they leave out the rigid motion).
// With --quick, --report, --busy, --seconds S (at most, a case) or --json FILE: percentiles and ratios, see
// frame_report.hpp. Counter `bytes_per_second`: R, rest position, output and the cache line that a write fetches first.
#include <benchmark/benchmark.h>
#include <cblas.h>

#include <cstdio>
#include <cstdlib>
#include <string>
#include <utility>

#include <skinbem/base/error.hpp>
#include <skinbem/base/rigid_fit.hpp>
#include <skinbem/frame/frame_model.hpp>

#include "frame_report.hpp"
#include "read_bandwidth.hpp"

namespace {

using namespace skinbem;

constexpr Index kLandmarks = 6;

struct Skin {
  explicit Skin(Index vertices, Index landmark_count = kLandmarks)
      : rest(100 * Points::Random(vertices, 3)),
        response(0.1 * Eigen::MatrixXd::Random(3 * vertices, 3 * landmark_count)),
        landmarks(100 * Points::Random(landmark_count, 3)),
        displacements(10 * Points::Random(landmark_count, 3)) {}

  Points rest;
  Eigen::MatrixXd response;
  Points landmarks;
  Points displacements;
};

void count_bytes(benchmark::State& state, Index vertices) {
  const double bytes = 3.0 * sizeof(float) * static_cast<double>(vertices * (3 * kLandmarks + 3));
  state.SetBytesProcessed(static_cast<std::int64_t>(bytes * static_cast<double>(state.iterations())));
}

void sizes(benchmark::internal::Benchmark* benchmark) {
  for (const int vertices : {606, 2000, 10000, 50000}) benchmark->Arg(vertices);
}

void rigid_fit(benchmark::State& state) {
  const Skin skin(1);
  for (auto _ : state) benchmark::DoNotOptimize(fit_rigid_displacement(skin.landmarks, skin.displacements));
}
BENCHMARK(rigid_fit);

/// Everything a frame costs: new landmarks, rigid fit, product.
void frame(benchmark::State& state) {
  const Skin skin(state.range(0));
  const FrameModel model(skin.rest, skin.response, skin.landmarks);
  FrameState frame_state(model);
  std::vector<float> positions(static_cast<std::size_t>(3 * model.vertex_count()));
  for (auto _ : state) {
    benchmark::DoNotOptimize(frame_state.set_landmarks(skin.displacements));
    frame_state.evaluate(positions);
    benchmark::ClobberMemory();
  }
  count_bytes(state, model.vertex_count());
}
BENCHMARK(frame)->Apply(sizes);

/// Many frames evaluated together: vertices, landmarks, frames.
void batches(benchmark::internal::Benchmark* benchmark) {
  constexpr std::pair<int, int> skins[] = {{606, 6}, {606, 40}, {2000, 100}, {10000, 40}, {10000, 100}, {50000, 40}};
  benchmark->ArgNames({"vertices", "landmarks", "frames"});
  for (const auto& [vertices, landmarks] : skins) {
    for (const int frames : {4, 8, 64}) benchmark->Args({vertices, landmarks, frames});
  }
}

/// Time is that of one frame of the batch. A frame's sums, two operations each, over time: Gflop/s.
void count_frames(benchmark::State& state) {
  const double sums = 9.0 * static_cast<double>(state.range(0) * state.range(1));
  state.counters["flops"] =
      benchmark::Counter(2 * sums * static_cast<double>(state.iterations()), benchmark::Counter::kIsRate);
}

void frame_of_batch(benchmark::State& state) {
  const Skin skin(state.range(0), state.range(1));
  const auto count = static_cast<std::size_t>(state.range(2));
  const FrameModel model(skin.rest, skin.response, skin.landmarks);
  std::vector<FrameState> frames(count, FrameState(model));
  for (FrameState& one : frames) {
    if (!one.set_landmarks(skin.displacements + Points::Random(skin.landmarks.rows(), 3))) std::abort();
  }
  std::vector<float> positions(count * static_cast<std::size_t>(3 * model.vertex_count()));
  while (state.KeepRunningBatch(state.range(2))) {
    evaluate_batch(frames, positions);
    benchmark::ClobberMemory();
  }
  count_frames(state);
}
BENCHMARK(frame_of_batch)->Apply(batches);

/// The same product and the rest positions, without the rigid motion.
void openblas_sgemm_of_batch(benchmark::State& state) {
  const Skin skin(state.range(0), state.range(1));
  const Eigen::MatrixXf response = skin.response.cast<float>();
  const Eigen::VectorXf rest = Eigen::Map<const Eigen::VectorXd>(skin.rest.data(), skin.rest.size()).cast<float>();
  const Eigen::MatrixXf q = Eigen::MatrixXf::Random(response.cols(), state.range(2));
  Eigen::MatrixXf positions(rest.size(), q.cols());
  const int rows = static_cast<int>(response.rows()), depth = static_cast<int>(q.rows());
  openblas_set_num_threads(1);
  while (state.KeepRunningBatch(state.range(2))) {
    positions.colwise() = rest;
    cblas_sgemm(CblasColMajor, CblasNoTrans, CblasNoTrans, rows, static_cast<int>(q.cols()), depth, 1, response.data(),
                rows, q.data(), depth, 1, positions.data(), rows);
    benchmark::ClobberMemory();
  }
  count_frames(state);
}
BENCHMARK(openblas_sgemm_of_batch)->Apply(batches);

void eigen_gemv(benchmark::State& state) {
  const Skin skin(state.range(0));
  const Eigen::MatrixXf response = skin.response.cast<float>();
  const Eigen::VectorXf rest = Eigen::Map<const Eigen::VectorXd>(skin.rest.data(), skin.rest.size()).cast<float>();
  const Eigen::VectorXf q = Eigen::VectorXf::Random(response.cols());
  Eigen::VectorXf positions(rest.size());
  for (auto _ : state) {
    positions = rest;
    positions.noalias() += response * q;
    benchmark::ClobberMemory();
  }
  count_bytes(state, skin.rest.rows());
}
BENCHMARK(eigen_gemv)->Apply(sizes);

void openblas_sgemv(benchmark::State& state) {
  const Skin skin(state.range(0));
  const Eigen::MatrixXf response = skin.response.cast<float>();
  const Eigen::VectorXf rest = Eigen::Map<const Eigen::VectorXd>(skin.rest.data(), skin.rest.size()).cast<float>();
  const Eigen::VectorXf q = Eigen::VectorXf::Random(response.cols());
  Eigen::VectorXf positions(rest.size());
  openblas_set_num_threads(1);
  for (auto _ : state) {
    positions = rest;
    cblas_sgemv(CblasColMajor, CblasNoTrans, static_cast<int>(response.rows()), static_cast<int>(response.cols()), 1,
                response.data(), static_cast<int>(response.rows()), q.data(), 1, 1, positions.data(), 1);
    benchmark::ClobberMemory();
  }
  count_bytes(state, skin.rest.rows());
}
BENCHMARK(openblas_sgemv)->Apply(sizes);

/// Reads a buffer of the bytes of R of that many vertices: what the cache level or the memory can deliver.
void read_bandwidth(benchmark::State& state) {
  const std::size_t floats = static_cast<std::size_t>(3 * state.range(0) * 3 * kLandmarks) / 256 * 256;
  const detail::AlignedVector<float> buffer(floats, 1.0F);
  for (auto _ : state) benchmark::DoNotOptimize(bench::read_stream(buffer.data(), floats));
  state.SetBytesProcessed(state.iterations() * static_cast<std::int64_t>(floats * sizeof(float)));
}
BENCHMARK(read_bandwidth)->Apply(sizes);

}  // namespace

/// Google Benchmark's own options, or the long measurement: [--quick | --report] [--busy] [--seconds S] [--json FILE].
int main(int argc, char** argv) {
  skinbem::bench::ReportOptions options;
  bool report = false;
  for (int i = 1; i < argc; ++i) {
    const std::string argument = argv[i];
    if (argument == "--quick") {
      report = options.quick = true;
    } else if (argument == "--report") {
      report = true;
    } else if (argument == "--busy") {
      report = options.busy = true;
    } else if (argument == "--seconds" && i + 1 < argc) {
      report = true;
      options.seconds = std::atof(argv[++i]);
    } else if (argument == "--json" && i + 1 < argc) {
      report = true;
      options.json = argv[++i];
    }
  }
  if (report) {
    try {
      skinbem::bench::frame_report(options);
      return 0;
    } catch (const skinbem::Error& error) {
      std::fprintf(stderr, "%s\n", error.what());
      return static_cast<int>(error.code());
    }
  }
  benchmark::Initialize(&argc, argv);
  if (benchmark::ReportUnrecognizedArguments(argc, argv)) return 2;
  benchmark::RunSpecifiedBenchmarks();
  return 0;
}
