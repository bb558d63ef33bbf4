// SPDX-License-Identifier: BSD-3-Clause
// Error against time, for boundary elements and, where compiled in, tetrahedral finite elements (docs/scaling.md):
// the response to landmarks, against an answer extrapolated from fine meshes, and a field that is known exactly.
#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <map>
#include <optional>
#include <skinbem/base/atomic_file.hpp>
#include <skinbem/io/npy.hpp>
#include <tuple>

#include "manufactured_field.hpp"
#include "temporary_folder.hpp"

namespace {

using namespace skinbem;
using namespace skinbem::bench;

struct Options {
  std::filesystem::path data = SKINBEM_LOWER_LIMB, json = {};
  std::vector<double> poisson{0.45, 0.49};
  std::vector<std::string> qualities{"q", "qa3", "qa1"};
  int levels = 4, rival_levels = 5, known_levels = 3, repeats = 3, threads = 1;
  double radius = 15, tolerance = 2e-4, truth_tolerance = 1e-5, memory = 0, seconds = 600;
};

Options parse(int argc, char** argv) {
  Options o;
  CLI::App app("Error against time, boundary and finite elements");
  app.add_option("--data", o.data, "folder of the limb that is refined")->capture_default_str();
  app.add_option("--json", o.json, "write all numbers to this file");
  app.add_option("--poisson", o.poisson, "Poisson's ratios, e.g. 0.45,0.49")->delimiter(',')->capture_default_str();
  app.add_option("--quality", o.qualities, "TetGen's switches, e.g. q,qa3")->delimiter(',')->capture_default_str();
  app.add_option("--levels", o.levels,
                 "meshes: 606 vertices, four times as many, ...; the truth is extrapolated from "
                 "the last three; 0: only the known field")
      ->check(CLI::Range(3, 5) | CLI::IsMember({0}))
      ->capture_default_str();
  app.add_option("--rival-levels", o.rival_levels, "meshes for finite elements, where more than for boundary elements")
      ->check(CLI::Range(0, 5))
      ->capture_default_str();
  app.add_option("--known-levels", o.known_levels,
                 "meshes for the known field, whose loads take time like their square; 0: only landmarks")
      ->check(CLI::Range(0, 5))
      ->capture_default_str();
  app.add_option("--repeats", o.repeats, "runs of which the median counts")->capture_default_str();
  app.add_option("--threads", o.threads)->capture_default_str();
  app.add_option("--radius", o.radius, "of the landmarks, mm")->capture_default_str();
  app.add_option("--tolerance", o.tolerance, "of boundary elements")->capture_default_str();
  app.add_option("--truth-tolerance", o.truth_tolerance, "of those the truth is made of")->capture_default_str();
  app.add_option("--memory", o.memory, "GB a run may take (default: 80 % of what is available)");
  app.add_option("--seconds", o.seconds, "a run may take")->capture_default_str();
  try {
    app.parse(argc, argv);
  } catch (const CLI::ParseError& error) {
    std::exit(app.exit(error));
  }
  return o;
}

ChildLimits limits_of(const Options& o) { return {o.memory > 0 ? o.memory * 1e9 : 0.8 * available_bytes(), o.seconds}; }

/// Boundary elements as in the paper, and with curved displacements and smooth loads; finite elements with each of the
/// qualities and such loads.
std::vector<ResponseCase> contenders(const Options& o, double poisson) {
  ResponseCase c{.poisson = poisson, .tolerance = o.tolerance, .threads = o.threads};
  std::vector<ResponseCase> cases;
  for (const Method method : methods()) {
    c.method = method;
    if (method == Method::boundary_elements) {
      for (const Displacements displacements : {Displacements::linear, Displacements::curved}) {
        c.displacements = displacements;
        c.loads = displacements == Displacements::curved ? Loads::smooth : Loads::linear;
        cases.push_back(c);
      }
      continue;
    }
    c.loads = Loads::smooth;
    for (const std::string& quality : o.qualities) {
      c.quality = quality;
      cases.push_back(c);
    }
  }
  return cases;
}

/// On meshes where only the rivals go on.
void leave_rivals(std::vector<ResponseCase>& cases) {
  std::erase_if(cases, [](const ResponseCase& c) { return c.method == Method::boundary_elements; });
}

/// An answer for the smooth body, with the numbers that say how far to trust it.
struct Truth {
  Eigen::MatrixXd R;
  double order;  ///< p of the error h^p, from three meshes
  double step;   ///< relative distance from the finest of them: what the extrapolation added
};

/// Richardson's extrapolation of answers A on three meshes, each of half the edges of the one before, in their common
/// rows: A_fine + (A_fine - A_middle) / (2^p - 1), 2^p = |A_middle - A_coarse| / |A_fine - A_middle|.
Truth extrapolate(const std::vector<Eigen::MatrixXd>& answers) {
  const Eigen::MatrixXd &fine = answers[2], &middle = answers[1], &coarse = answers[0];
  const double ratio = (middle - coarse).norm() / (fine - middle).norm();
  const Eigen::MatrixXd R = fine + (fine - middle) / (ratio - 1);
  return {R, std::log2(ratio), (R - fine).norm() / R.norm()};
}

/// The last three of `levels` skins by the method of `c`, in the rows of the first's vertices; nothing where one fails.
std::optional<Truth> truth_by(ResponseCase c, const std::vector<Skin>& skins, const Options& o) {
  const TemporaryFolder folder;
  c.keep = folder.path() / "R.npy";
  c.tolerance = o.truth_tolerance;
  std::vector<Eigen::MatrixXd> answers;
  const auto levels = static_cast<std::size_t>(o.levels);
  for (std::size_t i = levels - 3; i < levels; ++i) {
    const nlohmann::json run = measure_response(skins[i], c, limits_of(o));
    if (run.contains("failure")) {
      std::fprintf(stderr, "%s, %ld vertices: %s\n", name_of(c.method), skins[i].mesh.vertex_count(),
                   run["failure"].get<std::string>().c_str());
      return {};
    }
    answers.push_back(read_npy(c.keep).topRows(3 * skins[0].mesh.vertex_count()));
  }
  return extrapolate(answers);
}

void print_row(const nlohmann::json& run) {
  const std::string method =
      run["method"].get<std::string>() + " " + run.value("quality", "") + run.value("displacements", "");
  std::printf("| %s | %.2f | %s | %ld |", run["experiment"].get<std::string>().c_str(), run["poisson"].get<double>(),
              method.c_str(), run["vertices"].get<long>());
  if (run.contains("failure")) {
    std::printf(" %s |\n", run["failure"].get<std::string>().c_str());
  } else {
    std::printf(" %.3f | %.2f | %.2e | %.2e |\n", run["seconds"]["total"].get<double>(),
                run["peak_bytes"].get<double>() / 1e9, run["rms_error"].get<double>(), run["max_error"].get<double>());
  }
  std::fflush(stdout);
}

/// `measure(case)` as often as asked, the contenders taking turns; a row each.
template <class Measure>
void take_turns(const std::string& experiment, const std::vector<ResponseCase>& cases, const Options& o,
                const Measure& measure, nlohmann::json& rows) {
  std::vector<std::vector<nlohmann::json>> runs(cases.size());
  for (int repeat = 0; repeat < o.repeats; ++repeat) {
    for (std::size_t i = 0; i < cases.size(); ++i) {
      if (runs[i].empty() || !runs[i].back().contains("failure")) runs[i].push_back(measure(cases[i]));
    }
  }
  for (const auto& mine : runs) {
    nlohmann::json row = mine.back().contains("failure") ? mine.back() : median_run(mine);
    row["experiment"] = experiment;
    print_row(row);
    rows.push_back(std::move(row));
  }
}

/// The response, against the extrapolated one; returns what there is to say of the truth.
nlohmann::json compare_responses(double poisson, const Options& o, nlohmann::json& rows) {
  const std::vector<Skin> skins = limb_skins(o.data, std::max(o.levels, o.rival_levels) - 1, o.radius);
  std::vector<ResponseCase> cases = contenders(o, poisson);
  const std::optional<Truth> truth = truth_by(cases[0], skins, o);
  if (!truth) return {{"poisson", poisson}, {"failure", "the truth needs more memory or time"}};
  nlohmann::json facts = {{"poisson", poisson}, {"order", truth->order}, {"step", truth->step}};
  if (cases.back().method == Method::finite_elements) {
    if (const auto other = truth_by(cases.back(), skins, o)) {
      facts.update({{"fem_order", other->order}, {"fem_step", other->step}});
      facts["fem_distance"] = (other->R - truth->R).norm() / truth->R.norm();
    }
  }
  const TemporaryFolder folder;
  for (std::size_t level = 0; level < skins.size(); ++level) {
    if (level == static_cast<std::size_t>(o.levels)) leave_rivals(cases);
    const auto measure = [&](ResponseCase c) {
      c.keep = folder.path() / "R.npy";
      nlohmann::json run = measure_response(skins[level], c, limits_of(o));
      if (!run.contains("failure")) run.update(errors_of(read_npy(c.keep).topRows(truth->R.rows()), truth->R));
      return run;
    };
    take_turns("landmarks", cases, o, measure, rows);
  }
  return facts;
}

void compare_with_known_field(double poisson, const Options& o, nlohmann::json& rows) {
  const std::vector<Skin> skins = limb_skins(o.data, std::max(o.known_levels, o.rival_levels) - 1, o.radius);
  std::vector<ResponseCase> cases = contenders(o, poisson);
  // 63 mm from the calf, a limb's thickness: smooth on the coarsest mesh, and nowhere simple.
  const PointLoad field{{120, 20, 300}, {1, 2, -1}, poisson};
  for (std::size_t level = 0; level < skins.size(); ++level) {
    if (level == static_cast<std::size_t>(o.known_levels)) leave_rivals(cases);
    take_turns(
        "known field", cases, o,
        [&](const ResponseCase& c) { return measure_manufactured(skins[level].mesh, field, c, limits_of(o)); }, rows);
  }
}

/// Seconds to an error by the runs of one experiment and method.
struct Reach {
  double seconds;
  bool reached;  ///< false: even the finest mesh, whose time this is, has a larger error
};

/// Between two meshes logarithms are interpolated. `runs` by rising number of vertices.
Reach seconds_to(double error, const std::vector<nlohmann::json>& runs) {
  const auto seconds = [&](std::size_t i) { return runs[i].at("seconds").at("total").get<double>(); };
  const auto error_of = [&](std::size_t i) { return runs[i].at("rms_error").get<double>(); };
  if (error >= error_of(0)) return {seconds(0), true};
  for (std::size_t i = 1; i < runs.size(); ++i) {
    if (error < error_of(i)) continue;
    const double share = std::log(error / error_of(i - 1)) / std::log(error_of(i) / error_of(i - 1));
    return {seconds(i - 1) * std::pow(seconds(i) / seconds(i - 1), share), true};
  }
  return {seconds(runs.size() - 1), false};
}

/// For each run of boundary elements, how many times longer finite elements of one quality need to the same error.
nlohmann::json at_equal_error(const nlohmann::json& rows) {
  std::map<std::tuple<std::string, double, std::string>, std::vector<nlohmann::json>> rivals;
  for (const nlohmann::json& row : rows) {
    if (row["method"] == "bem" || row.contains("failure")) continue;
    rivals[{row["experiment"], row["poisson"], row["quality"]}].push_back(row);
  }
  nlohmann::json table = nlohmann::json::array();
  for (const nlohmann::json& row : rows) {
    if (row["method"] != "bem" || row.contains("failure")) continue;
    for (const auto& [key, runs] : rivals) {
      if (std::get<0>(key) != row["experiment"] || std::get<1>(key) != row["poisson"]) continue;
      const Reach reach = seconds_to(row["rms_error"], runs);
      const double times = reach.seconds / row["seconds"]["total"].get<double>();
      table.push_back({{"experiment", row["experiment"]},
                       {"poisson", row["poisson"]},
                       {"quality", std::get<2>(key)},
                       {"displacements", row["displacements"]},
                       {"vertices", row["vertices"]},
                       {"rms_error", row["rms_error"]},
                       {"times", times},
                       {"reached", reach.reached}});
    }
  }
  return table;
}

void print_equal_error(const nlohmann::json& table) {
  for (const nlohmann::json& row : table) {
    std::printf(
        "%s, nu %.2f: to the error %.2e of boundary elements (%s) on %ld vertices finite elements (%s) need %s%.2f "
        "times as long\n",
        row["experiment"].get<std::string>().c_str(), row["poisson"].get<double>(), row["rms_error"].get<double>(),
        row["displacements"].get<std::string>().c_str(), row["vertices"].get<long>(),
        row["quality"].get<std::string>().c_str(), row["reached"].get<bool>() ? "" : "more than ",
        row["times"].get<double>());
  }
}

}  // namespace

int main(int argc, char** argv) try {
  const Options o = parse(argc, argv);
  nlohmann::json rows = nlohmann::json::array(), truths = nlohmann::json::array();
  std::printf(
      "| experiment | nu | method | vertices | total s | peak GB | rms error | max error |\n"
      "|---|---|---|---|---|---|---|---|\n");
  for (const double poisson : o.poisson) {
    if (o.known_levels > 0) compare_with_known_field(poisson, o, rows);
    if (o.levels > 0) truths.push_back(compare_responses(poisson, o, rows));
  }
  const nlohmann::json equal_error = at_equal_error(rows);
  print_equal_error(equal_error);
  for (const nlohmann::json& truth : truths) std::printf("truth: %s\n", truth.dump().c_str());
  if (!o.json.empty()) {
    const nlohmann::json report = {{"processor", processor_name()}, {"landmark_radius", o.radius},
                                   {"repeats", o.repeats},          {"truths", truths},
                                   {"equal_error", equal_error},    {"runs", rows}};
    write_file_atomically(o.json, [&](std::ostream& out) { out << report.dump(1) << "\n"; });
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
