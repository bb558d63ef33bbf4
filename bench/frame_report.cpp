// SPDX-License-Identifier: BSD-3-Clause
#include "frame_report.hpp"

#include <cblas.h>
#include <omp.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <nlohmann/json.hpp>
#include <numeric>
#include <thread>
#include <vector>

#include <skinbem/base/atomic_file.hpp>
#include <skinbem/frame/frame_model.hpp>

#include "read_bandwidth.hpp"

namespace skinbem::bench {
namespace {

using Clock = std::chrono::steady_clock;

/// How R is kept: as FrameStorage does it, or the frame in double that writes files (evaluate_reference).
enum class Kept { float64, float32, int16, compressed };

struct Case {
  Index vertices;
  Index landmarks;
  Kept kept;
  int threads;
};

const char* name_of(Kept kept) {
  constexpr const char* names[] = {"float64", "float32", "int16", "compressed"};
  return names[static_cast<int>(kept)];
}

FrameOptions options_of(Kept kept) {
  if (kept == Kept::int16) return {FrameMode::corotated, FrameStorage::int16};
  if (kept == Kept::compressed) return {FrameMode::corotated, FrameStorage::compressed};
  return {FrameMode::corotated, FrameStorage::float32};
}

/// Numbers like those of a leg: every landmark acts about its place, smoothly, and weakly everywhere.
struct Skin {
  explicit Skin(const Case& c)
      : rest(c.vertices, 3), landmarks(c.landmarks, 3), response(3 * c.vertices, 3 * c.landmarks) {
    std::srand(1);
    const auto on_leg = [](double s, double angle) {
      return Vec3(60 * std::cos(angle), 60 * std::sin(angle), 400 * s);
    };
    // Along a spiral, so that neighbours in number are neighbours in space, as they are in most files.
    const auto turns = std::sqrt(static_cast<double>(c.vertices));
    for (Index i = 0; i < c.vertices; ++i) {
      const double s = static_cast<double>(i) / static_cast<double>(c.vertices);
      rest.row(i) = on_leg(s, 2 * M_PI * turns * s);
    }
    for (Index k = 0; k < c.landmarks; ++k) {
      landmarks.row(k) =
          on_leg((static_cast<double>(k) + 0.5) / static_cast<double>(c.landmarks), 2.4 * static_cast<double>(k));
    }
    const double reach = 150 / std::sqrt(static_cast<double>(c.landmarks));
    for (Index i = 0; i < c.vertices; ++i) {
      Eigen::VectorXd weight(c.landmarks);
      for (Index k = 0; k < c.landmarks; ++k) {
        weight(k) = 1 / (1 + (rest.row(i) - landmarks.row(k)).squaredNorm() / (reach * reach));
      }
      weight /= weight.sum();
      for (Index k = 0; k < c.landmarks; ++k) {
        response.block<3, 3>(3 * i, 3 * k) = weight(k) * (Mat3::Identity() + 0.1 * Mat3::Ones() * weight(k));
      }
    }
  }

  Points rest;
  Points landmarks;
  Eigen::MatrixXd response;
};

/// Times of one way to do the work, and what it does.
struct Contender {
  std::function<void()> run;
  std::vector<double> microseconds = {};

  double mean() const {
    return std::accumulate(microseconds.begin(), microseconds.end(), 0.0) / static_cast<double>(microseconds.size());
  }
  double percentile(double share) {
    const auto place = static_cast<std::ptrdiff_t>(share * static_cast<double>(microseconds.size() - 1));
    std::nth_element(microseconds.begin(), microseconds.begin() + place, microseconds.end());
    return microseconds[static_cast<std::size_t>(place)];
  }
};

double seconds_since(Clock::time_point start) { return std::chrono::duration<double>(Clock::now() - start).count(); }

/// How long a contender runs in its turn; what is before that is not measured.
struct Turn {
  double settle;
  double timed;
};

/// One thread: a first frame brings its data back into the cache. Several: its threads wake up.
Turn turn_of(int threads) { return threads == 1 ? Turn{0, 1e-3} : Turn{12e-3, 12e-3}; }

/// Runs the contenders in turns of frames one after the other, until `frames` each or `budget` seconds in all.
void measure(std::vector<Contender*> contenders, const Turn& turn, std::size_t frames, double budget) {
  const auto start = Clock::now();
  while (contenders.front()->microseconds.size() < frames && seconds_since(start) < budget) {
    for (Contender* contender : contenders) {
      auto begin = Clock::now();
      do contender->run();
      while (seconds_since(begin) < turn.settle);
      begin = Clock::now();
      for (int i = 0; i < 10 || seconds_since(begin) < turn.timed; ++i) {
        const auto frame = Clock::now();
        contender->run();
        contender->microseconds.push_back(1e6 * seconds_since(frame));
      }
    }
  }
}

/// Every thread reads its `floats` numbers in one of the ways of read_bandwidth.hpp.
void read_in_parallel(float (&read)(const float*, std::size_t), const float* data, std::size_t floats, int threads) {
  if (threads == 1) {
    volatile float sink = read(data, floats);
    static_cast<void>(sink);
    return;
  }
#pragma omp parallel for num_threads(threads) schedule(static, 1)
  for (int t = 0; t < threads; ++t) {
    volatile float sink = read(data + static_cast<std::size_t>(t) * floats, floats);
    static_cast<void>(sink);
  }
}

/// The library's frames of one skin: as the case asks for, and in other ways to compare with.
class OurFrames {
 public:
  OurFrames(const Skin& skin, const Case& c)
      : case_(c),
        skin_(skin),
        model_(skin.rest, skin.response, skin.landmarks, options_of(c.kept)),
        single_(skin.rest, skin.response, skin.landmarks),
        displacements_(10 * Points::Random(c.landmarks, 3)),
        positions_(static_cast<std::size_t>(3 * c.vertices)) {
    must(state_.set_landmarks(displacements_));
    must(single_state_.set_landmarks(displacements_));
    motion_ = state_.motion();
  }
  OurFrames(const OurFrames&) = delete;
  OurFrames& operator=(const OurFrames&) = delete;

  const FrameModel& model() const { return model_; }

  Contender asked{[this] {
    if (case_.kept == Kept::float64) {
      in_double_ = evaluate_reference(skin_.rest, skin_.response, motion_);
    } else {
      set();
      must(state_.evaluate(VertexTarget{positions_}, threads_));
    }
  }};
  Contender float32{[this] { must(single_state_.evaluate(VertexTarget{positions_}, threads_)); }};
  Contender one_thread{[this] {
    set();
    must(state_.evaluate(VertexTarget{positions_}));
  }};
  Contender with_rigid_fit{[this] {
    must(state_.set_landmarks(displacements_));
    must(state_.evaluate(VertexTarget{positions_}, threads_));
  }};

 private:
  static void must(bool done) {
    if (!done) std::abort();
  }
  /// The setter of a compressed model does a part of the product, so it is counted; the rigid fit is not.
  void set() {
    if (case_.kept == Kept::compressed) must(state_.set_motion(motion_));
  }

  Case case_;
  const Skin& skin_;
  FrameModel model_, single_;
  Points displacements_;
  FrameState state_{model_}, single_state_{single_};
  BodyMotion motion_;
  FrameThreads threads_{case_.threads};
  std::vector<float> positions_;
  Points in_double_;
};

/// The same product, without rotation, by the libraries for matrices.
struct LibraryProducts {
  explicit LibraryProducts(const Skin& skin)
      : response(skin.response.cast<float>()),
        rest(Eigen::Map<const Eigen::VectorXd>(skin.rest.data(), skin.rest.size()).cast<float>()) {}
  LibraryProducts(const LibraryProducts&) = delete;
  LibraryProducts& operator=(const LibraryProducts&) = delete;

  Eigen::MatrixXf response;
  Eigen::VectorXf rest;
  Eigen::VectorXf q = Eigen::VectorXf::Random(response.cols());
  Eigen::VectorXf out{rest.size()};
  Contender eigen{[this] {
    out = rest;
    out.noalias() += response * q;
  }};
  Contender openblas{[this] {
    out = rest;
    cblas_sgemv(CblasColMajor, CblasNoTrans, static_cast<int>(response.rows()), static_cast<int>(response.cols()), 1,
                response.data(), static_cast<int>(response.rows()), q.data(), 1, 1, out.data(), 1);
  }};
};

nlohmann::json measured(const Case& c, std::size_t frames, double budget) {
  const Skin skin(c);
  OurFrames ours(skin, c);
  omp_set_num_threads(c.threads);
  LibraryProducts library(skin);

  // What a frame moves: the packed model, the output, and the lines of the output that a write fetches first.
  const double numbers = 9.0 * static_cast<double>(c.vertices * (c.landmarks + 1));
  const double bytes = (c.kept == Kept::float64 ? 8 * numbers : static_cast<double>(ours.model().bytes())) +
                       24.0 * static_cast<double>(c.vertices);
  const auto shares = static_cast<std::size_t>(c.threads);
  const std::size_t floats = static_cast<std::size_t>(bytes / sizeof(float)) / shares / 256 * 256;
  const detail::AlignedVector<float> buffer(floats * shares, 1.0F);
  Contender stream{[&] { read_in_parallel(read_stream, buffer.data(), floats, c.threads); }};
  Contender in_turns{[&] { read_in_parallel(read_in_turns, buffer.data(), floats, c.threads); }};

  // OpenMP's threads spin for some milliseconds after their work, on the core where ours would help: after those of one
  // library come those of one thread (Eigen's product has one), before those of the other.
  measure({&ours.asked, &ours.float32, &ours.with_rigid_fit, &stream, &in_turns, &library.openblas, &library.eigen,
           &ours.one_thread},
          turn_of(c.threads), frames, budget);
  Contender& read = in_turns.percentile(0.5) < stream.percentile(0.5) ? in_turns : stream;
  nlohmann::json row;
  row["vertices"] = c.vertices;
  row["landmarks"] = c.landmarks;
  row["storage"] = name_of(c.kept);
  row["threads"] = c.threads;
  row["p50_us"] = ours.asked.percentile(0.5);
  row["p99_us"] = ours.asked.percentile(0.99);
  row["p999_us"] = ours.asked.percentile(0.999);
  row["max_us"] = ours.asked.percentile(1);
  row["with_rigid_fit_us"] = ours.with_rigid_fit.percentile(0.5);
  row["mean_us"] = ours.asked.mean();
  row["one_thread_mean_us"] = ours.one_thread.mean();
  row["float32_us"] = ours.float32.percentile(0.5);
  row["eigen_us"] = library.eigen.percentile(0.5);
  row["openblas_us"] = library.openblas.percentile(0.5);
  row["read_us"] = read.percentile(0.5);
  row["eigen_p99_us"] = library.eigen.percentile(0.99);
  row["openblas_p99_us"] = library.openblas.percentile(0.99);
  row["read_p99_us"] = read.percentile(0.99);
  row["bandwidth_fraction"] = read.percentile(0.5) / ours.asked.percentile(0.5);
  row["bytes"] = bytes;
  row["gigabytes_per_second"] = bytes * 1e-3 / ours.asked.percentile(0.5);
  row["error_bound"] = ours.model().achieved_error_bound();
  row["frames"] = ours.asked.microseconds.size();
  return row;
}

std::vector<Case> cases(bool quick) {
  std::vector<Case> result;
  for (const Kept kept : {Kept::float32, Kept::int16, Kept::compressed, Kept::float64}) {
    for (const Index vertices : {606, 2000, 10000, 50000, 500000}) {
      for (const Index landmarks : {6, 40, 100, 300}) {
        // Beyond, the model in double alone takes gigabytes; the small ones show the same behaviour.
        const double numbers = 9.0 * static_cast<double>(vertices * landmarks);
        if (numbers > (quick ? 3e7 : 1e8)) continue;
        // Compression is for many landmarks, and takes seconds to make.
        if (kept == Kept::compressed && (landmarks < 40 || numbers > (quick ? 4e6 : 3e7))) continue;
        if (kept == Kept::float64 && quick && (landmarks > 6 || vertices > 50000)) continue;
        result.push_back({vertices, landmarks, kept, 1});
        const bool large = vertices >= 10000 && kept != Kept::float64;
        if (large && (!quick || landmarks == 6)) result.push_back({vertices, landmarks, kept, 2});
      }
    }
  }
  return result;
}

}  // namespace

void frame_report(const ReportOptions& options) {
  std::printf("instruction set %s; times in microseconds, percentiles of a frame\n", detail::instruction_set());
  std::printf("%8s %9s %10s %7s %9s %9s %9s %9s %9s %9s %9s %9s %7s %7s %7s %7s %9s\n", "vertices", "landmarks",
              "storage", "threads", "p50", "p99", "p99.9", "max", "with fit", "float32", "Eigen", "OpenBLAS", "of read",
              "p99/50", "read's", "GB/s", "error");
  nlohmann::json rows = nlohmann::json::array();
  std::jthread neighbour;
  if (options.busy) {
    neighbour = std::jthread([](const std::stop_token& stop) {
      while (!stop.stop_requested()) continue;
    });
  }
  for (const Case& c : cases(options.quick)) {
    const nlohmann::json row = measured(c, options.quick ? 2000 : 100000, options.quick ? 0.2 : options.seconds);
    const auto number = [&](const char* key) { return row[key].get<double>(); };
    std::printf("%8ld %9ld %10s %7d %9.2f %9.2f %9.2f %9.2f %9.2f %9.2f %9.2f %9.2f %7.2f %7.2f %7.2f %7.1f %9.1e\n",
                c.vertices, c.landmarks, name_of(c.kept), c.threads, number("p50_us"), number("p99_us"),
                number("p999_us"), number("max_us"), number("with_rigid_fit_us"), number("float32_us"),
                number("eigen_us"), number("openblas_us"), number("bandwidth_fraction"),
                number("p99_us") / number("p50_us"), number("read_p99_us") / number("read_us"),
                number("gigabytes_per_second"), number("error_bound"));
    if (c.threads > 1) {
      std::printf("%38s mean %.2f, of one thread %.2f\n", "", number("mean_us"), number("one_thread_mean_us"));
    }
    std::fflush(stdout);
    rows.push_back(row);
  }
  if (options.json) {
    write_file_atomically(*options.json, [&](std::ostream& out) { out << rows.dump(1) << '\n'; });
  }
}

}  // namespace skinbem::bench
