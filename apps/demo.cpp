// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <filesystem>

#include <skinbem/base/atomic_file.hpp>
#include <skinbem/base/error.hpp>
#include <skinbem/base/stopwatch.hpp>
#include <skinbem/frame/frame_model.hpp>
#include <skinbem/io/npy.hpp>
#include <skinbem/io/picture.hpp>

#include "animation_run.hpp"
#include "commands.hpp"
#include "console.hpp"
#include "embedded_limb.hpp"

namespace {

namespace fs = std::filesystem;

constexpr double paper_precomputation_seconds = 244, paper_frames_per_second = 25;  // Tang (2010)
constexpr double landmark_radius = 15;                                              // mm
constexpr int poses = 8;
constexpr skinbem::Index looked_at = 4;  // every fourth frame is judged: 25 a second

void unpack_limb(const fs::path& folder) {
  std::error_code error;
  fs::create_directories(folder / "bones", error);
  if (error) {
    throw skinbem::Error(skinbem::ErrorCode::io, folder.string() + ": cannot create the folder: " + error.message());
  }
  for (const EmbeddedFile& file : embedded_limb()) {
    skinbem::write_file_atomically(folder / file.name, [&](std::ostream& out) { out << file.text; });
  }
}

/// Seconds of one frame in real time: setting the landmarks and evaluating the skin, the mean over some thousand.
double frame_seconds(const ResponseRun& run, const Animation& animation) {
  const skinbem::FrameModel model(run.mesh.vertices, run.response, run.positions);
  skinbem::FrameState state(model);
  std::vector<float> positions(3 * static_cast<std::size_t>(model.vertex_count()));
  skinbem::Points displacements(model.landmark_count(), 3);
  constexpr int repetitions = 5000;
  const skinbem::Stopwatch watch;
  for (int i = 0; i < repetitions; ++i) {
    const Eigen::VectorXd weights = animation.skin.weights.row(i % animation.skin.frame_count());
    displacements = Eigen::Map<const skinbem::Points>(weights.data(), model.landmark_count(), 3);
    state.set_landmarks(displacements);
    state.evaluate(positions);
  }
  return watch.seconds() / repetitions;
}

/// A motion of the demo, and the part of it (0: start, 1: end) that its picture shows.
struct Motion {
  std::string name;
  double from, to;
};

/// A strip of poses, evenly over that part of the motion, seen from the side: the skin, and the bones through it.
void draw_strip(const fs::path& path, const Animation& animation, const Motion& motion) {
  std::vector<std::vector<skinbem::PictureMesh>> strip;
  for (int i = 0; i < poses; ++i) {
    const double part = motion.from + (motion.to - motion.from) * i / (poses - 1);
    const auto f = static_cast<skinbem::Index>(part * static_cast<double>(animation.skin.frame_count() - 1));
    skinbem::PictureMesh skin, bones;
    skin.mesh = {skinbem::skin_vertices(animation.skin, f), animation.skin.rest.triangles};
    skin.colour = skinbem::skin_colour;
    skin.opacity = 0.55f;
    bones.mesh = skinbem::bones_mesh(animation.bones, f);
    bones.colour = skinbem::bone_colour;
    strip.push_back({bones, skin});
  }
  skinbem::PictureOptions options;
  options.width = 260;
  options.height = 560;
  skinbem::write_png(path, skinbem::contact_sheet(strip, {{1, 0.25, 0}, {0, 0, 1}}, options));
}

void demo(const fs::path& folder) {
  require_name(folder);
  const fs::path limb = folder / "lower_limb";
  unpack_limb(limb);

  ResponseRunOptions response;
  response.mesh = (limb / "skin.obj").string();
  response.landmarks = (limb / "landmarks.csv").string();
  response.radius = landmark_radius;
  const ResponseRun run = run_response(response);
  skinbem::write_npy(folder / "response.npy", run.response);
  fmt::print("{}", skinbem::to_text(run.report));

  double seconds = 0;
  for (const Motion& motion : {Motion{"walk", 0.3, 0.53}, Motion{"jump", 0.15, 0.8}}) {
    const std::string& name = motion.name;
    AnimationOptions options;
    options.motion = (limb / (name + ".bvh")).string();
    options.rig = (limb / "rig.toml").string();
    options.bones = (limb / "bones").string();
    options.artefact.kind = skinbem::ArtefactKind::trial;
    const Animation animation = animate(run, read_motion(options), options);
    write_animation((folder / (name + ".glb")).string(), animation);
    draw_strip(folder / (name + ".png"), animation, motion);
    fmt::print(
        "{}       {} frames; at worst {}\n", name, animation.skin.frame_count(),
        quality_text(skinbem::worst_of(skinbem::deformation_quality(animation.skin, animation.bones, looked_at))));
    seconds = frame_seconds(run, animation);
  }
  fmt::print(
      "\n                     here              Tang (2010)\n"
      "precomputation       {:<12.3g} s    {:.0f} s\n"
      "frames a second      {:<12.3g}      {:.0f}\n\n"
      "Written to {}: walk.glb, jump.glb, walk.png, jump.png, response.npy, lower_limb/\n",
      run.report.seconds.total, paper_precomputation_seconds, 1 / seconds, paper_frames_per_second, folder.string());
}

}  // namespace

void add_demo(CLI::App& program) {
  auto folder = std::make_shared<std::string>("skinbem_demo");
  CLI::App* command = program.add_subcommand("demo", "The embedded lower limb walks and jumps");
  command->add_option("-o,--output", *folder, "Folder for what is made")->capture_default_str();
  command->footer("Example: skinbem demo -o demo");
  command->callback([folder] { demo(*folder); });
}
