// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The rig: which bones and landmarks move together, and what in a motion file moves them. docs/rig.md describes the
/// file.
#pragma once

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include <skinbem/base/types.hpp>

namespace skinbem {

enum class MotionFormat { bvh, trc };

/// Bones that move as one rigid body. Points and axes are in mesh coordinates at rest.
struct RigSegment {
  std::string name;
  Index parent = -1;                   ///< index into Rig::segments, -1 for the root
  std::vector<std::string> bones;      ///< names as bone_name() gives them
  std::vector<std::string> landmarks;  ///< those that follow this segment whatever bone their table names
  Vec3 joint;                          ///< the point that stays together with the parent's
  // BVH: the frame (proximal -> distal, flexion axis), in the mesh and in the motion
  Vec3 proximal, distal, axis;
  std::string proximal_joint, distal_joint;
  Vec3 motion_axis;  ///< the flexion axis in the proximal joint's own axes
  // TRC
  std::vector<std::string> markers;  ///< three or more, not on a line
};

/// A place known in both worlds at the rest frame: a marker, or a point of the laboratory, and where it is on the mesh.
struct Placement {
  std::variant<std::string, Vec3> laboratory;  ///< marker's name, or a point in millimetres
  Vec3 mesh;
};

struct Rig {
  std::string path;  ///< of the rig file, for messages
  MotionFormat format = MotionFormat::bvh;
  std::vector<RigSegment> segments;  ///< the root first, parents before their children

  /// Rotation that takes the axes of the motion file (its up, its forward) to those of the mesh.
  Mat3 axes = Mat3::Identity();
  Vec3 mesh_up = Vec3::UnitZ();
  double mesh_floor = 0;    ///< height of the ground in the mesh, along mesh_up
  double motion_floor = 0;  ///< height of the ground in the motion file, in its unit (TRC: millimetres)

  std::optional<double> scale;  ///< BVH: unit of the mesh per unit of the file
  std::string scale_segment;    ///< without `scale`: the ratio of this segment's lengths in mesh and file

  double rest_time = 0;  ///< TRC: seconds, of the rest frame
  bool chained = false;  ///< TRC: joints stay together; else each segment takes its markers' own translation
  std::vector<Placement> placement;                 ///< TRC: three or more, not on a line
  std::map<std::string, std::string> skin_markers;  ///< TRC: landmark -> the marker glued on it

  /// Index of the segment that holds the bone (any spelling that bone_name() knows), or -1.
  Index segment_of_bone(const std::string& bone) const;
};

/// A bone's name without folder and ending: "bones/tibia.obj" is "tibia".
std::string bone_name(const std::string& bone);

/// Reads `path`. Throws Error(io) when it cannot be read and Error(bad_input) "path:line: ..." for what is wrong in it:
/// unknown or missing keys, a parent that is no segment, a bone or landmark in two segments, degenerate axes.
Rig read_rig(const std::filesystem::path& path);

}  // namespace skinbem
