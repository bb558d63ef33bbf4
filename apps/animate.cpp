// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <map>

#include <skinbem/mesh/adjacency.hpp>

#include "animation_run.hpp"
#include "commands.hpp"
#include "console.hpp"
#include "option_values.hpp"

namespace {

constexpr double fine_edge = 5;  // unit of the mesh, millimetres in what we ship

struct Options {
  ResponseRunOptions response;
  AnimationOptions animation;
  std::string response_file, output;
  bool per_frame = false;
};

/// A point load's own displacement grows as the mesh is refined.
void warn_of_fine_points(const ResponseRun& run) {
  const skinbem::IndexLists neighbours = skinbem::neighbours_of_vertices(run.mesh);
  for (const skinbem::Landmark& landmark : run.landmarks) {
    const double edge = skinbem::shortest_edge(run.mesh, neighbours, landmark.vertex);
    if (landmark.radius == 0 && edge < fine_edge) {
      warn(
          fmt::format("landmark {} is a point where edges are {:.2g} long: its pull depends on the mesh, give --radius",
                      landmark.name, edge));
    }
  }
}

void run_animate(const Options& options) {
  require_output(options.output,
                 {options.response.mesh, options.response.landmarks, options.response_file, options.animation.motion,
                  options.animation.rig, options.animation.fine_skin, options.animation.bones});
  const RiggedMotion motion = read_motion(options.animation);  // its errors come before a long solve
  const ResponseRun run = run_response(options.response, options.response_file);
  warn_of_fine_points(run);
  const Animation animation = animate(run, motion, options.animation);
  const std::vector<skinbem::FrameQuality> quality = skinbem::deformation_quality(animation.skin, animation.bones);
  write_animation(options.output, animation);
  if (options.response.json) {
    fmt::print("{}\n", skinbem::to_json(run.report));
    return;
  }
  if (options.per_frame) {
    fmt::print("frame,time,volume_change,edge_stretch,bones_outside\n");
    for (std::size_t f = 0; f < quality.size(); ++f) {
      fmt::print("{},{:.6g},{:.6g},{:.6g},{:.6g}\n", f, animation.skin.times[f], quality[f].volume_change,
                 quality[f].edge_stretch, quality[f].bones_outside);
    }
    return;
  }
  fmt::print("{}frames     {} in {}\nat worst   {}\n", skinbem::to_text(run.report), animation.skin.frame_count(),
             options.output, quality_text(skinbem::worst_of(quality)));
}

void add_motion_options(CLI::App& command, AnimationOptions& a) {
  using skinbem::ArtefactKind, skinbem::FrameMode, skinbem::MotionMode;
  static const std::map<std::string, MotionMode> modes{
      {"follow", MotionMode::follow}, {"literal", MotionMode::literal}, {"markers", MotionMode::markers}};
  static const std::map<std::string, FrameMode> frames{{"corotated", FrameMode::corotated},
                                                       {"linear", FrameMode::linear}};
  static const std::map<std::string, ArtefactKind> artefacts{{"none", ArtefactKind::none},
                                                             {"trial", ArtefactKind::trial},
                                                             {"correlated", ArtefactKind::correlated},
                                                             {"frame", ArtefactKind::frame}};
  command.add_option("--motion", a.motion, "BVH or TRC file")->required();
  command.add_option("--rig", a.rig, "TOML file: which bones and landmarks move with what in the motion")->required();
  command.add_option("--mode", a.mode, "follow (default), literal (the paper's equation 4) or markers")
      ->transform(word(modes))
      ->option_text("MODE");
  command.add_option("--frame", a.frame, "corotated (default) or linear (the paper's)")
      ->transform(word(frames))
      ->option_text("KIND");
  command.add_option("--artefact", a.artefact.kind, "Sliding of the skin: none (default), trial, correlated or frame")
      ->transform(word(artefacts))
      ->option_text("KIND");
  command.add_option("--artefact-mean", a.artefact.mean, "Unit of the mesh")->check(number())->capture_default_str();
  command.add_option("--artefact-sigma", a.artefact.sigma, "Unit of the mesh")->check(number())->capture_default_str();
  command.add_option("--seed", a.artefact.seed, "Of the artefact")
      ->check(
          number([](double value) { return value >= 0 && value == std::floor(value); }, "a whole number, zero or more"))
      ->capture_default_str();
  command.add_option("--fps", a.fps, "Frames a second; that of the motion when not given")
      ->check(number([](double value) { return value > 0; }, "a positive number"));
  command.add_option("--from", a.from, "Seconds of the motion file")->check(number());
  command.add_option("--to", a.to, "Seconds of the motion file")->check(number());
  command.add_option("--skin", a.fine_skin, "A finer skin of the same body, driven by the response of MESH");
  command.add_option("--bones", a.bones, "Folder of bones that move along");
}

}  // namespace

void add_animate(CLI::App& program) {
  auto options = std::make_shared<Options>();
  CLI::App* command = program.add_subcommand("animate", "A skin that follows a motion, as GLB, PVD or OBJ files");
  add_response_options(*command, options->response);
  add_motion_options(*command, options->animation);
  command->add_option("--response", options->response_file, "R.npy of an earlier `skinbem response`");
  command->add_option("-o,--output", options->output, "OUT.glb, OUT.pvd, or a folder for OBJ files")->required();
  command->add_flag("--per-frame", options->per_frame, "Print the quality of every frame as CSV");
  command->footer(
      "Example: skinbem animate skin.obj --landmarks landmarks.csv --motion walk.bvh --rig rig.toml\n"
      "           --radius 15 --bones bones -o walk.glb");
  command->callback([options] { run_animate(*options); });
}
