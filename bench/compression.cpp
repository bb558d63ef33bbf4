// SPDX-License-Identifier: BSD-3-Clause
// compression SKIN.obj LANDMARKS [--fine FINE.obj] [--json FILE]: the response matrix of that many landmarks spread
// over a skin, interpolated to a finer skin of the same body where one is given: its singular values, and the frames of
// its three forms in turns (setter, with the part of the product that compression puts there, and evaluation).
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>

#include <skinbem/base/atomic_file.hpp>
#include <skinbem/base/error.hpp>
#include <skinbem/frame/frame_model.hpp>
#include <skinbem/mesh/mesh_io.hpp>
#include <skinbem/response/interpolation.hpp>
#include <skinbem/response/response_model.hpp>

namespace {

using namespace skinbem;
using Clock = std::chrono::steady_clock;

double microseconds_since(Clock::time_point begin) {
  return std::chrono::duration<double, std::micro>(Clock::now() - begin).count();
}

double median(std::vector<double> values) {
  const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
  std::nth_element(values.begin(), middle, values.end());
  return *middle;
}

/// Each landmark as far from those before it as it can be.
std::vector<Landmark> spread(const TriangleMesh& skin, Index count) {
  std::vector<Landmark> landmarks;
  Eigen::VectorXd distance = Eigen::VectorXd::Constant(skin.vertex_count(), 1e300);
  for (Index next = 0; Index(landmarks.size()) < count; distance.maxCoeff(&next)) {
    landmarks.push_back({.name = std::to_string(next), .vertex = static_cast<std::int32_t>(next)});
    distance = distance.cwiseMin((skin.vertices.rowwise() - skin.vertices.row(next)).rowwise().norm());
  }
  return landmarks;
}

/// Those below 1e-8 of the largest are rounding.
Eigen::VectorXd singular_values(const Eigen::MatrixXd& R) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(R.transpose() * R, Eigen::EigenvaluesOnly);
  return eigen.eigenvalues().reverse().cwiseMax(0).cwiseSqrt();
}

nlohmann::json measured(const Points& rest, const Eigen::MatrixXd& R, const Points& landmark_rest) {
  nlohmann::json result;
  std::vector<FrameModel> models;
  for (const FrameStorage storage : {FrameStorage::float32, FrameStorage::int16, FrameStorage::compressed}) {
    const auto begin = Clock::now();
    models.emplace_back(rest, R, landmark_rest, FrameOptions(FrameMode::linear, storage));
    result["make_seconds"].push_back(1e-6 * microseconds_since(begin));
    result["megabytes"].push_back(1e-6 * static_cast<double>(models.back().bytes()));
    result["error_bound"].push_back(models.back().achieved_error_bound());
  }
  std::vector<FrameState> states(models.begin(), models.end());
  std::vector<std::vector<double>> times(models.size());
  const Points displacements = 10 * Points::Random(landmark_rest.rows(), 3);
  std::vector<float> positions(static_cast<std::size_t>(3 * rest.rows()));
  for (int turn = 0; turn < 50; ++turn) {
    for (std::size_t s = 0; s < states.size(); ++s) {
      for (int i = 0; i < 20; ++i) {
        const auto begin = Clock::now();
        if (!states[s].set_landmarks(displacements) || !states[s].evaluate(positions)) std::abort();
        if (i > 0) times[s].push_back(microseconds_since(begin));  // the first brings its data back into the cache
      }
    }
  }
  for (const auto& t : times) result["p50_us"].push_back(median(t));
  return result;
}

int run(int argc, char** argv) {
  const TriangleMesh skin = read_mesh(argv[1]);
  std::optional<std::string> fine_name, json;
  for (int i = 3; i + 1 < argc; i += 2) (std::string(argv[i]) == "--fine" ? fine_name : json) = argv[i + 1];
  ResponseModel model(skin);
  model.add(spread(skin, std::atoi(argv[2])));
  Eigen::MatrixXd R = model.response();
  Points rest = skin.vertices;
  if (fine_name) {
    const TriangleMesh fine = read_mesh(*fine_name);
    R = SkinInterpolation(skin.vertices, fine).apply(R);
    rest = fine.vertices;
  }
  nlohmann::json result = measured(rest, R, model.landmark_positions());
  const Eigen::VectorXd values = singular_values(R);
  result["vertices"] = rest.rows();
  result["landmarks"] = R.cols() / 3;
  result["singular_values"] = std::vector<double>(values.begin(), values.end());
  std::printf("%ld vertices, %ld landmarks: singular values %.3g to %.3g\n", rest.rows(), R.cols() / 3, values(0),
              values(values.size() - 1));
  constexpr const char* names[] = {"float32", "int16", "compressed"};
  for (std::size_t s = 0; s < 3; ++s) {
    std::printf("%-10s %7.2f MB, error at most %.1e, made in %.2f s, frame %8.1f us, %.2f x float32\n", names[s],
                result["megabytes"][s].get<double>(), result["error_bound"][s].get<double>(),
                result["make_seconds"][s].get<double>(), result["p50_us"][s].get<double>(),
                result["p50_us"][0].get<double>() / result["p50_us"][s].get<double>());
  }
  if (json) write_file_atomically(*json, [&](std::ostream& out) { out << result.dump(1) << '\n'; });
  return 0;
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 3 || argc % 2 == 0) {
    std::fprintf(stderr, "usage: compression SKIN.obj LANDMARKS [--fine FINE.obj] [--json FILE]\n");
    return 2;
  }
  return run(argc, argv);
} catch (const skinbem::Error& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return static_cast<int>(error.code());
}
