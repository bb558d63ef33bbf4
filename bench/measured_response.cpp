// SPDX-License-Identifier: BSD-3-Clause
#include "measured_response.hpp"

#include <omp.h>

#include <algorithm>
#include <fstream>
#include <skinbem/base/stopwatch.hpp>
#include <skinbem/io/npy.hpp>
#include <skinbem/mesh/mesh_io.hpp>
#include <skinbem/response/landmark_table.hpp>
#include <skinbem/response/response_model.hpp>

#include "subdivision.hpp"
#ifdef SKINBEM_BENCH_RIVAL
#include "tetrahedral_fem.hpp"
#endif

namespace skinbem::bench {
namespace {

struct Response {
  Eigen::MatrixXd R;
  nlohmann::json facts;
};

Response by_boundary_elements(const Skin& skin, const ResponseCase& c) {
  ResponseModel model(
      skin.mesh, {.poisson = c.poisson, .tolerance = c.tolerance, .displacements = c.displacements, .loads = c.loads});
  model.add(skin.landmarks);
  Response response{model.response(), {}};
  const ResponseSummary& s = model.summary();
  response.facts = {
      {"unknowns", 3 * skin.mesh.vertex_count()},
      {"solver", name_of(s.prediction.solver)},
      {"predicted", {{"seconds", s.prediction.seconds}, {"bytes", s.prediction.bytes}}},
      {"seconds", {{"assemble", s.assemble_seconds}, {"factor", s.factor_seconds}, {"solve", s.solve_seconds}}},
      {"iterations", s.iterations},
      {"residual", s.residual},
      {"estimated_error", s.estimated_error}};
  return response;
}

#ifdef SKINBEM_BENCH_RIVAL
Response by_finite_elements(const Skin& skin, const ResponseCase& c) {
  TetrahedralFem fem(skin.mesh, {.poisson = c.poisson, .quality = c.quality, .loads = c.loads});
  Response response{fem.response(skin.landmarks), {}};
  const TetrahedralFemSummary& s = fem.summary();
  response.facts = {{"unknowns", 3 * s.nodes},
                    {"tetrahedra", s.tetrahedra},
                    {"seconds",
                     {{"mesh", s.mesh_seconds},
                      {"assemble", s.assemble_seconds},
                      {"factor", s.factor_seconds},
                      {"solve", s.solve_seconds}}},
                    {"factor_bytes", s.factor_bytes}};
  return response;
}
#else
Response by_finite_elements(const Skin&, const ResponseCase&) {
  throw Error(ErrorCode::usage, "finite elements were not compiled in (SKINBEM_BENCH_RIVAL)");
}
#endif

Skin with_landmarks(const char* family, TriangleMesh mesh, const std::filesystem::path& file, double radius) {
  Skin skin{family, std::move(mesh), {}};
  skin.landmarks = read_landmarks(file, skin.mesh, radius).landmarks;
  return skin;
}

}  // namespace

std::vector<Skin> limb_skins(const std::filesystem::path& data, int times, double radius) {
  std::vector<Skin> skins;
  for (TriangleMesh& mesh : smooth_refinements(read_mesh(data / "skin.obj"), times)) {
    skins.push_back(with_landmarks("limb", std::move(mesh), data / "landmarks.csv", radius));
  }
  return skins;
}

std::vector<Skin> given_skins(const std::filesystem::path& folder, double radius) {
  std::vector<Skin> skins;
  for (const auto& entry : std::filesystem::directory_iterator(folder)) {
    const std::string name = entry.path().filename();
    if (!name.starts_with("skin") || !name.ends_with(".obj")) continue;
    skins.push_back(with_landmarks("given", read_mesh(entry.path()), folder / "landmarks.csv", radius));
  }
  std::sort(skins.begin(), skins.end(),
            [](const Skin& a, const Skin& b) { return a.mesh.vertex_count() < b.mesh.vertex_count(); });
  return skins;
}

const char* name_of(Method method) { return method == Method::boundary_elements ? "bem" : "fem"; }

std::vector<Method> methods() {
#ifdef SKINBEM_BENCH_RIVAL
  return {Method::boundary_elements, Method::finite_elements};
#else
  return {Method::boundary_elements};
#endif
}

nlohmann::json measure_response(const Skin& skin, const ResponseCase& c, const ChildLimits& limits) {
  const auto work = [&] {
    omp_set_num_threads(c.threads);
    Stopwatch watch;
    Response response =
        c.method == Method::boundary_elements ? by_boundary_elements(skin, c) : by_finite_elements(skin, c);
    response.facts["seconds"]["total"] = watch.lap();
    if (!c.keep.empty()) write_npy(c.keep, response.R);
    return response.facts;
  };
  return described(run_in_child(work, limits), skin.family, skin.mesh.vertex_count(), c);
}

nlohmann::json described(const ChildOutcome& outcome, const std::string& family, Index vertices,
                         const ResponseCase& c) {
  nlohmann::json run = {{"method", name_of(c.method)}, {"family", family},     {"vertices", vertices},
                        {"threads", c.threads},        {"poisson", c.poisson}, {"peak_bytes", outcome.peak_bytes}};
  if (c.method == Method::boundary_elements) {
    run["tolerance"] = c.tolerance;
    run["displacements"] = c.displacements == Displacements::curved ? "curved" : "linear";
  } else {
    run["quality"] = c.quality;
  }
  if (outcome.failure.empty()) {
    run.update(outcome.result);
  } else {
    run["failure"] = outcome.failure;
  }
  return run;
}

nlohmann::json median_run(std::vector<nlohmann::json> runs) {
  const auto middle = runs.begin() + static_cast<std::ptrdiff_t>(runs.size() / 2);
  const auto total = [](const nlohmann::json& run) { return run.at("seconds").at("total").get<double>(); };
  std::nth_element(runs.begin(), middle, runs.end(), [&](const auto& a, const auto& b) { return total(a) < total(b); });
  return *middle;
}

std::string processor_name() {
  std::ifstream file("/proc/cpuinfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("model name")) return line.substr(line.find(':') + 2);
  }
  return "unknown";
}

}  // namespace skinbem::bench
