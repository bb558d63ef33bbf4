// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// From the response and a motion to an animation: what `animate` and `demo` share.
#pragma once

#include <string>
#include <vector>

#include <skinbem/frame/body_motion.hpp>
#include <skinbem/io/animation.hpp>
#include <skinbem/io/deformation_quality.hpp>
#include <skinbem/motion/landmark_motion.hpp>

#include "response_run.hpp"

struct AnimationOptions {
  std::string motion, rig, bones, fine_skin;
  skinbem::MotionMode mode = skinbem::MotionMode::follow;
  skinbem::FrameMode frame = skinbem::FrameMode::corotated;
  skinbem::ArtefactOptions artefact;
  double fps = 0;  ///< 0: of the motion file
  double from = -std::numeric_limits<double>::infinity(), to = std::numeric_limits<double>::infinity();
};

struct Animation {
  skinbem::SkinAnimation skin;
  std::vector<skinbem::MovingBone> bones;
};

/// A rig and how its segments move in the asked frames.
struct RiggedMotion {
  skinbem::Rig rig;
  skinbem::SkeletonMotion skeleton;
};

RiggedMotion read_motion(const AnimationOptions& options);

Animation animate(const ResponseRun& run, const RiggedMotion& rigged, const AnimationOptions& options);

/// Writes .glb, .pvd, or an OBJ sequence into a folder (a name without extension, or that ends with a slash).
void write_animation(const std::string& output, const Animation& animation);
/// Throws Error(usage) for an output that write_animation does not know, Error(io) for one that cannot be written;
/// Error(usage) too for one that is an input.
void require_output(const std::string& output, const std::vector<std::string>& inputs);

std::string quality_text(const skinbem::FrameQuality& worst);
