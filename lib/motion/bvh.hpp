// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Motion of a skeleton of joints: the BVH format (Biovision hierarchy).
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <skinbem/base/types.hpp>

namespace skinbem {

enum class BvhChannel { x_position, y_position, z_position, x_rotation, y_rotation, z_rotation };

struct BvhJoint {
  std::string name;                  ///< an End Site of joint J is named "J.end"
  Index parent = -1;                 ///< -1 for a root
  Vec3 offset = Vec3::Zero();        ///< from the parent's origin, in the parent's axes, unit of the file
  std::vector<BvhChannel> channels;  ///< in the order of the file; empty for an End Site
  Index first_channel = 0;           ///< column of channels[0] in BvhMotion::values
};

struct BvhMotion {
  std::vector<BvhJoint> joints;  ///< parents before their children
  double frame_time = 0;         ///< seconds, > 0
  Eigen::MatrixXd values;        ///< #frames (>= 1) by #channels; lengths in the unit of the file, angles in degrees

  Index frame_count() const { return values.rows(); }
  /// Index of the joint called `name`, or -1.
  Index find(const std::string& name) const;
};

/// Reads `path` strictly: any order of channels, any number of roots. Throws Error(io) when it cannot be read and
/// Error(bad_input) "path:line: ..." for an unknown keyword, a missing or superfluous value, a number that is not
/// finite, a frame count that is not kept, a frame time that is not positive, two joints of one name.
BvhMotion read_bvh(const std::filesystem::path& path);

/// Where every joint is in frame `frame`: world = result[j](point in the axes of joint j); the translation is the
/// joint's position. Rotation channels multiply in the order of the file, position channels replace the joint's offset.
std::vector<RigidMotion> joint_poses(const BvhMotion& motion, Index frame);

}  // namespace skinbem
