// SPDX-License-Identifier: BSD-3-Clause
#include "response_run.hpp"

#include <fmt/format.h>
#include <omp.h>

#include <skinbem/base/error.hpp>
#include <skinbem/base/stopwatch.hpp>
#include <skinbem/io/npy.hpp>
#include <skinbem/mesh/adjacency.hpp>
#include <skinbem/mesh/mesh_io.hpp>
#include <skinbem/mesh/validate.hpp>
#include <skinbem/response/landmark_patch.hpp>
#include <skinbem/response/landmark_table.hpp>
#include <skinbem/solve/rigid_modes.hpp>

#include "console.hpp"
#include "option_values.hpp"

namespace {

constexpr double not_of_these = 1e-4;  // rigid error of a response that is not of this mesh and these landmarks
constexpr int most_threads = 1024;     // many more and the OpenMP run time crashes

using skinbem::Error;
using skinbem::ErrorCode;
using skinbem::Index;

void read_inputs(const ResponseRunOptions& options, ResponseRun& run) {
  run.mesh = skinbem::read_mesh(options.mesh, {options.weld});
  for (const skinbem::Defect& defect : skinbem::require_body(run.mesh, options.mesh, {options.force}).warnings) {
    warn(options.mesh + ": " + skinbem::message(defect));
  }
  skinbem::LandmarkTable table = skinbem::read_landmarks(options.landmarks, run.mesh, options.radius);
  for (const skinbem::LandmarkSnap& snap : table.snaps) {
    warn(fmt::format("{}: landmark {} was taken to vertex {}, {:.3g} from its coordinates", options.landmarks,
                     snap.name, snap.vertex, snap.distance));
  }
  run.landmarks = std::move(table.landmarks);
}

/// Landmarks that move as one rigid body move the skin as that body: how far `run.response` is from doing so, relative
/// to the motion.
double rigid_error(const ResponseRun& run) {
  const Index vertices = run.mesh.vertex_count(), landmarks = run.positions.rows();
  skinbem::Points all(vertices + landmarks, 3);
  all << run.mesh.vertices, run.positions;
  const Eigen::MatrixXd modes = skinbem::rigid_modes(all);
  const auto skin = modes.topRows(3 * vertices), moved = modes.bottomRows(3 * landmarks);
  return (run.response * moved - skin).cwiseAbs().maxCoeff() / skin.cwiseAbs().maxCoeff();
}

/// R from a file of an earlier run, for the same mesh and landmarks.
void read_response(const ResponseRunOptions& options, const std::string& file, ResponseRun& run) {
  run.report.solver = "file";
  run.response = skinbem::read_npy(file);
  const Index rows = run.mesh.vertices.size(), columns = 3 * static_cast<Index>(run.landmarks.size());
  if (run.response.rows() != rows || run.response.cols() != columns) {
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: is {} by {}, {} and {} need {} by {}: make it anew with `skinbem response`", file,
                            run.response.rows(), run.response.cols(), options.mesh, options.landmarks, rows, columns));
  }
  const skinbem::IndexLists triangles = skinbem::triangles_around_vertices(run.mesh);
  const Eigen::VectorXd areas = skinbem::vertex_areas(run.mesh);
  run.positions.resize(static_cast<Index>(run.landmarks.size()), 3);
  for (Index k = 0; k < run.positions.rows(); ++k) {
    const auto patch =
        skinbem::make_patch(run.mesh, triangles, areas, run.landmarks[static_cast<std::size_t>(k)], options.loads);
    run.positions.row(k) = patch.measure(run.mesh.vertices).transpose();
  }
  if (!(rigid_error(run) < not_of_these)) {
    throw Error(ErrorCode::bad_input,
                fmt::format("{}: does not move {} along with a rigid motion of {}: it is damaged or of another mesh, "
                            "other landmarks, another --radius or other --loads; make it anew with `skinbem response`",
                            file, options.mesh, options.landmarks));
  }
}

void compute_response(const ResponseRunOptions& options, ResponseRun& run) {
  skinbem::ResponseOptions solve;
  solve.poisson = options.poisson;
  solve.displacements = options.displacements;
  solve.loads = options.loads;
  solve.tolerance = options.tolerance;
  solve.solver = options.solver;
  solve.memory_limit = static_cast<std::size_t>(options.memory_gigabytes * 1e9);
  solve.progress = terminal_progress();
  solve.validate();
  skinbem::ResponseModel model(run.mesh, solve);
  try {
    model.add(run.landmarks);
    run.response = model.response();
  } catch (const Error& error) {
    if (error.code() != ErrorCode::bad_input) throw;
    throw Error(error.code(), options.landmarks + ": " + error.what());
  }
  run.positions = model.landmark_positions();
  const skinbem::ResponseSummary& summary = model.summary();
  run.report.solver = skinbem::name_of(summary.prediction.solver);
  run.report.predicted = {summary.prediction.seconds, static_cast<std::int64_t>(summary.prediction.bytes)};
  run.report.poisson = options.poisson;
  run.report.tolerance = options.tolerance;
  run.report.estimated_error = summary.estimated_error;
  run.report.residual = summary.residual;
  run.report.iterations = summary.iterations;
  run.report.seconds.assemble = summary.assemble_seconds;
  run.report.seconds.factor = summary.factor_seconds;
  run.report.seconds.solve = summary.solve_seconds;
  end_progress();
}

}  // namespace

void add_response_options(CLI::App& command, ResponseRunOptions& options) {
  command.add_option("MESH", options.mesh, "Closed triangle mesh: OBJ, OFF, STL or PLY")->required();
  command.add_option("--landmarks", options.landmarks, "CSV with name and vertex and/or x,y,z")->required();
  command.add_option("--poisson", options.poisson, "Poisson's ratio in (-1, 0.5]")
      ->check(number())
      ->capture_default_str();
  command.add_option("--radius", options.radius, "Of landmarks whose file gives none, unit of the mesh; 0: a point")
      ->check(number([](double value) { return value >= 0; }, "a length, zero or more"))
      ->capture_default_str();
  command
      .add_option("--displacements", options.displacements,
                  "Between vertices: linear, or curved as their gradients say, nearer to the continuous body")
      ->transform(word<skinbem::Displacements>(
          {{"linear", skinbem::Displacements::linear}, {"curved", skinbem::Displacements::curved}}))
      ->type_name("TEXT")
      ->default_str("linear");
  command
      .add_option("--loads", options.loads,
                  "Landmarks' tractions between vertices: linear, or smooth: landmarks may be smaller than triangles")
      ->transform(word<skinbem::Loads>({{"linear", skinbem::Loads::linear}, {"smooth", skinbem::Loads::smooth}}))
      ->type_name("TEXT")
      ->default_str("linear");
  command.add_option("--solver", options.solver, "How the equations are solved: auto, dense or hmatrix (compressed)")
      ->transform(word<skinbem::Solver>({{"auto", skinbem::Solver::automatic},
                                         {"dense", skinbem::Solver::dense},
                                         {"hmatrix", skinbem::Solver::hmatrix}}))
      ->type_name("TEXT")
      ->default_str("auto");
  command.add_option("--memory", options.memory_gigabytes, "GB that may be used; 0: what the system has available")
      ->check(number([](double value) { return value >= 0; }, "a size in GB, zero or more"))
      ->capture_default_str();
  command.add_option("--tolerance", options.tolerance, "Relative error of the response, 1e-12 to 1e-1")
      ->check(number())
      ->capture_default_str();
  command
      .add_option("--threads", options.threads,
                  "0: as many as there are; beside busy programs set OMP_WAIT_POLICY=passive")
      ->check(number([](double value) { return value >= 0 && value <= most_threads; },
                     fmt::format("a number of threads, 0 to {}", most_threads)))
      ->capture_default_str();
  command.add_flag("--weld", options.weld, "Make vertices at equal positions one");
  command.add_flag("--force", options.force, "Go on where the mesh crosses itself");
  command.add_flag("--json", options.json, "Print the report as one JSON object");
}

ResponseRun run_response(const ResponseRunOptions& options, const std::string& response_file) {
  const skinbem::Stopwatch total;
  if (options.threads > 0) omp_set_num_threads(options.threads);
  ResponseRun run;
  read_inputs(options, run);
  run.report.seconds.read = total.seconds();
  if (response_file.empty()) {
    compute_response(options, run);
  } else {
    read_response(options, response_file, run);
  }
  skinbem::RunReport& report = run.report;
  report.version = SKINBEM_VERSION;
  report.vertices = run.mesh.vertex_count();
  report.triangles = run.mesh.triangle_count();
  report.volume = skinbem::volume(run.mesh);
  report.landmarks = static_cast<int>(run.landmarks.size());
  report.threads = omp_get_max_threads();
  report.seconds.total = total.seconds();
  report.peak_bytes = skinbem::peak_resident_bytes();
  return run;
}
