// SPDX-License-Identifier: BSD-3-Clause
#include "animation_run.hpp"

#include <fmt/format.h>

#include <algorithm>

#include <skinbem/base/error.hpp>
#include <skinbem/io/gltf.hpp>
#include <skinbem/io/obj_sequence.hpp>
#include <skinbem/io/vtk.hpp>
#include <skinbem/mesh/mesh_io.hpp>
#include <skinbem/motion/rig.hpp>
#include <skinbem/response/interpolation.hpp>

#include "console.hpp"

namespace {

namespace fs = std::filesystem;
using skinbem::Error;
using skinbem::ErrorCode;
using skinbem::Index;

std::vector<fs::path> mesh_files(const fs::path& folder) {
  if (!fs::is_directory(folder)) throw Error(ErrorCode::io, folder.string() + ": there is no such folder of bones");
  std::vector<fs::path> files;
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string end = entry.path().extension().string();
    if (end == ".obj" || end == ".off" || end == ".stl" || end == ".ply") files.push_back(entry.path());
  }
  if (files.empty()) throw Error(ErrorCode::bad_input, folder.string() + ": holds no mesh (OBJ, OFF, STL, PLY)");
  std::sort(files.begin(), files.end());
  return files;
}

std::vector<skinbem::MovingBone> moving_bones(const fs::path& folder, const skinbem::Rig& rig,
                                              const skinbem::SkeletonMotion& skeleton) {
  std::vector<skinbem::MovingBone> bones;
  for (const fs::path& file : mesh_files(folder)) {
    const Index segment = rig.segment_of_bone(file.stem().string());
    if (segment < 0) {
      warn(file.string() + ": no segment of the rig has this bone, it is left out");
      continue;
    }
    skinbem::MovingBone bone{file.stem().string(), skinbem::read_mesh(file), {}};
    for (const auto& frame : skeleton.segments) bone.motion.push_back(frame[static_cast<std::size_t>(segment)]);
    bones.push_back(std::move(bone));
  }
  return bones;
}

std::vector<std::string> target_names(const std::vector<skinbem::Landmark>& landmarks) {
  std::vector<std::string> names;
  for (const skinbem::Landmark& landmark : landmarks) {
    for (const char* axis : {".x", ".y", ".z"}) names.push_back(landmark.name + axis);
  }
  return names;
}

}  // namespace

RiggedMotion read_motion(const AnimationOptions& options) {
  RiggedMotion motion{skinbem::read_rig(options.rig), {}};
  motion.skeleton = skinbem::resampled(skinbem::read_skeleton_motion(motion.rig, options.motion), options.fps,
                                       options.from, options.to);
  return motion;
}

Animation animate(const ResponseRun& run, const RiggedMotion& rigged, const AnimationOptions& options) {
  const skinbem::Rig& rig = rigged.rig;
  const skinbem::LandmarkMotion motion =
      skinbem::landmark_motion(rig, rigged.skeleton, run.landmarks, run.positions, options.mode, options.artefact);
  for (const std::string& name : motion.unmarked) warn("landmark " + name + " has no marker, it follows its bone");

  Animation animation;
  skinbem::SkinAnimation& skin = animation.skin;
  skin.rest = run.mesh;
  skin.targets = run.response;
  if (!options.fine_skin.empty()) {
    skin.rest = skinbem::read_mesh(options.fine_skin);
    skin.targets = skinbem::SkinInterpolation(run.mesh.vertices, skin.rest, terminal_progress()).apply(run.response);
  }
  skin.target_names = target_names(run.landmarks);
  const Index frames = motion.displacements.rows(), landmarks = run.positions.rows();
  skin.weights.resize(frames, 3 * landmarks);
  skinbem::BodyMotion body = skinbem::BodyMotion::at_rest(landmarks);
  for (Index f = 0; f < frames; ++f) {
    const Eigen::VectorXd row = motion.displacements.row(f);
    skinbem::split_motion(run.positions, Eigen::Map<const skinbem::Points>(row.data(), landmarks, 3), options.frame,
                          body);
    skin.times.push_back(motion.skeleton.first_time + static_cast<double>(f) / motion.skeleton.frames_per_second);
    skin.body.push_back(body.rigid);
    skin.weights.row(f) = body.weights.transpose();
  }
  if (!options.bones.empty()) animation.bones = moving_bones(options.bones, rig, motion.skeleton);
  return animation;
}

void require_output(const std::string& output, const std::vector<std::string>& inputs) {
  const fs::path path(output);
  const std::string end = path.extension().string();
  if (path.has_filename() && !end.empty() && end != ".glb" && end != ".pvd") {
    throw Error(ErrorCode::usage, output + ": unknown kind of output, name a .glb, a .pvd or a folder/");
  }
  end == ".glb" || end == ".pvd" ? require_writable_file(path, inputs) : require_writable(path, inputs);
}

void write_animation(const std::string& output, const Animation& animation) {
  const std::string end = fs::path(output).extension().string();
  if (end == ".glb") {
    skinbem::GltfOptions look;
    if (!animation.bones.empty()) look.skin_opacity = 0.5;
    for (const std::string& warning : skinbem::write_glb(output, animation.skin, animation.bones, look)) warn(warning);
  } else if (end == ".pvd") {
    skinbem::write_vtk_sequence(output, animation.skin, animation.bones, terminal_progress());
  } else {
    skinbem::write_obj_sequence(output, animation.skin, animation.bones, terminal_progress());
  }
  end_progress();
}

std::string quality_text(const skinbem::FrameQuality& worst) {
  return fmt::format(
      "volume change {:+.2f} %, 99th percentile of edge stretch {:.1f} %, bone vertices outside {:.2f} %",
      100 * worst.volume_change, 100 * worst.edge_stretch, 100 * worst.bones_outside);
}
