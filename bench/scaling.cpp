// SPDX-License-Identifier: BSD-3-Clause
// Time and memory from mesh to response matrix against the number of vertices, for boundary elements and, where
// compiled in, tetrahedral finite elements of the same skin and landmarks (docs/scaling.md). Every run has a process of
// its own; the methods take turns, and the run of median time counts.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <skinbem/base/atomic_file.hpp>
#include <skinbem/io/npy.hpp>

#include "measured_response.hpp"
#include "temporary_folder.hpp"

namespace {

using namespace skinbem;
using namespace skinbem::bench;

struct Options {
  std::filesystem::path data = SKINBEM_LOWER_LIMB;
  std::filesystem::path skins = {}, json = {};
  std::vector<int> threads{1};
  Index smallest = 0, largest = 160000;
  int repeats = 3;
  double radius = 15, fit_from = 5000, memory = 0, seconds = 600, reference = 0;
  bool quick = false;
  ResponseCase common = {};
};

Options parse(int argc, char** argv) {
  Options o;
  CLI::App app("Time and memory from mesh to response matrix against the number of vertices");
  app.add_option("--data", o.data, "folder of the limb that is refined")->capture_default_str();
  app.add_option("--skins", o.skins, "folder of more skins (skin*.obj, landmarks.csv)");
  app.add_option("--json", o.json, "write all numbers to this file");
  app.add_option("--threads", o.threads, "numbers of threads, e.g. 1,2")->delimiter(',')->capture_default_str();
  app.add_option("--smallest", o.smallest, "skip skins of fewer vertices")->capture_default_str();
  app.add_option("--largest", o.largest, "skip skins of more vertices")->capture_default_str();
  app.add_option("--repeats", o.repeats, "runs of which the median counts")->capture_default_str();
  app.add_option("--tolerance", o.common.tolerance, "of boundary elements")->capture_default_str();
  app.add_option("--poisson", o.common.poisson)->capture_default_str();
  app.add_option("--radius", o.radius, "of the landmarks, mm")->capture_default_str();
  app.add_option("--quality", o.common.quality, "TetGen's switches")->capture_default_str();
  app.add_option("--reference", o.reference, "measure the error of R against this tolerance");
  app.add_option("--fit-from", o.fit_from, "fewest vertices of a fitted exponent")->capture_default_str();
  app.add_option("--memory", o.memory, "GB a run may take (default: 80 % of what is available)");
  app.add_option("--seconds", o.seconds, "a run may take")->capture_default_str();
  app.add_flag("--quick", o.quick, "the two smallest limbs, once");
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error));
  }
  if (o.quick) o.repeats = 1;
  return o;
}

/// 606, 2418, 9666, 38658, 154626 vertices.
std::vector<Skin> skins_of(const Options& o) {
  int times = 0;
  for (Index vertices = 606; 4 * vertices <= o.largest; vertices *= 4) ++times;
  std::vector<Skin> skins = limb_skins(o.data, o.quick ? std::min(times, 1) : times, o.radius);
  if (!o.skins.empty() && !o.quick) {
    for (Skin& skin : given_skins(o.skins, o.radius)) {
      if (skin.mesh.vertex_count() <= o.largest) skins.push_back(std::move(skin));
    }
  }
  std::erase_if(skins, [&](const Skin& skin) { return skin.mesh.vertex_count() < o.smallest; });
  return skins;
}

double total_of(const nlohmann::json& run) { return run.at("seconds").at("total"); }

void print_heading() {
  std::printf(
      "| skin | vertices | method | threads | mesh s | assemble s | factor s | solve s | total s | peak GB | "
      "iterations | error of R |\n|---|---|---|---|---|---|---|---|---|---|---|---|\n");
}

void print_row(const nlohmann::json& run) {
  std::printf("| %s | %ld | %s | %d |", run["family"].get<std::string>().c_str(), run["vertices"].get<long>(),
              run["method"].get<std::string>().c_str(), run["threads"].get<int>());
  if (run.contains("failure")) {
    std::printf(" %s |\n", run["failure"].get<std::string>().c_str());
    return;
  }
  for (const char* stage : {"mesh", "assemble", "factor", "solve", "total"}) {
    std::printf(run["seconds"].contains(stage) ? " %.3f |" : " |", run["seconds"].value(stage, 0.0));
  }
  std::printf(" %.2f |", run["peak_bytes"].get<double>() / 1e9);
  std::printf(run.contains("iterations") ? " %d |" : " |", run.value("iterations", 0));
  std::printf(run.contains("error") ? " %.1e |\n" : " |\n", run.value("error", 0.0));
}

/// max|R - R_reference| / max|R_reference|, where the reference can be made.
std::optional<double> error_of(const Skin& skin, const std::filesystem::path& response, const Options& o,
                               const ChildLimits& limits, const TemporaryFolder& folder) {
  ResponseCase tight = o.common;
  tight.tolerance = o.reference;
  tight.threads = o.threads.back();
  tight.keep = folder.path() / "reference.npy";
  if (const nlohmann::json run = measure_response(skin, tight, limits); run.contains("failure")) {
    std::fprintf(stderr, "no reference: %s\n", run["failure"].get<std::string>().c_str());
    return {};
  }
  const Eigen::MatrixXd exact = read_npy(tight.keep);
  return (read_npy(response) - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff();
}

/// All methods and numbers of threads for one skin, taking turns; a row each.
std::vector<nlohmann::json> measure_skin(const Skin& skin, const Options& o) {
  const ChildLimits limits{o.memory > 0 ? o.memory * 1e9 : 0.8 * available_bytes(), o.seconds};
  const TemporaryFolder folder;
  std::map<std::pair<int, Method>, std::vector<nlohmann::json>> runs;
  for (int repeat = 0; repeat < o.repeats; ++repeat) {
    for (const int threads : o.threads) {
      for (const Method method : methods()) {
        auto& mine = runs[{threads, method}];
        if (!mine.empty() && mine.back().contains("failure")) continue;
        ResponseCase c = o.common;
        c.method = method;
        c.threads = threads;
        if (o.reference > 0) c.keep = folder.path() / (std::string(name_of(method)) + ".npy");
        mine.push_back(measure_response(skin, c, limits));
      }
    }
  }
  std::optional<double> error;
  const bool solved = !runs[{o.threads.back(), Method::boundary_elements}].back().contains("failure");
  if (o.reference > 0 && solved) error = error_of(skin, folder.path() / "bem.npy", o, limits, folder);
  std::vector<nlohmann::json> rows;
  for (auto& [key, mine] : runs) {
    nlohmann::json row = mine.back().contains("failure") ? mine.back() : median_run(mine);
    if (error && key.second == Method::boundary_elements && !row.contains("failure")) row["error"] = *error;
    print_row(row);
    rows.push_back(std::move(row));
  }
  std::fflush(stdout);
  return rows;
}

/// Slope of log y over log(vertices) by least squares.
double exponent(const std::vector<std::pair<double, double>>& points) {
  double n = 0, x = 0, y = 0, xx = 0, xy = 0;
  for (const auto& [vertices, value] : points) {
    const double a = std::log(vertices), b = std::log(value);
    n += 1, x += a, y += b, xx += a * a, xy += a * b;
  }
  return (n * xy - x * y) / (n * xx - x * x);
}

/// Exponents of time and memory of each method on the limb.
nlohmann::json fit(const std::vector<nlohmann::json>& rows, double from) {
  std::map<std::pair<std::string, int>, std::vector<std::pair<double, double>>> times, bytes;
  for (const nlohmann::json& row : rows) {
    const double vertices = row["vertices"];
    if (row.contains("failure") || row["family"] != "limb" || vertices < from) continue;
    const std::pair<std::string, int> key{row["method"], row["threads"]};
    times[key].emplace_back(vertices, total_of(row));
    bytes[key].emplace_back(vertices, row["peak_bytes"]);
  }
  nlohmann::json fits = nlohmann::json::array();
  for (const auto& [key, points] : times) {
    if (points.size() < 2) continue;
    fits.push_back({{"method", key.first},
                    {"threads", key.second},
                    {"from", points.front().first},
                    {"to", points.back().first},
                    {"time", exponent(points)},
                    {"memory", exponent(bytes[key])}});
    std::printf("%s, %d threads, %.0f to %.0f vertices: time ~ N^%.2f, memory ~ N^%.2f\n", key.first.c_str(),
                key.second, points.front().first, points.back().first, exponent(points), exponent(bytes[key]));
  }
  return fits;
}

}  // namespace

int main(int argc, char** argv) try {
  const Options o = parse(argc, argv);
  std::vector<nlohmann::json> rows;
  print_heading();
  for (const Skin& skin : skins_of(o)) {
    for (nlohmann::json& row : measure_skin(skin, o)) rows.push_back(std::move(row));
  }
  const nlohmann::json fits = fit(rows, o.quick ? 0 : o.fit_from);
  if (!o.json.empty()) {
    const nlohmann::json report = {{"processor", processor_name()},
                                   {"landmark_radius", o.radius},
                                   {"repeats", o.repeats},
                                   {"runs", rows},
                                   {"exponents", fits}};
    write_file_atomically(o.json, [&](std::ostream& out) { out << report.dump(1) << "\n"; });
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
