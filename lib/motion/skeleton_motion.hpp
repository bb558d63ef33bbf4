// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The motion of a rig's segments: what a motion file and a rig give together, in the axes of the mesh.
#pragma once

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include <skinbem/motion/bvh.hpp>
#include <skinbem/motion/rig.hpp>
#include <skinbem/motion/trc.hpp>

namespace skinbem {

/// Frames at equal steps of time, in the axes and the unit of the mesh.
struct SkeletonMotion {
  double frames_per_second = 0;
  double first_time = 0;                           ///< seconds in the motion file, of the first frame
  std::vector<std::string> segment_names;          ///< as in the rig
  std::vector<Index> parents;                      ///< of the segments, as in the rig
  std::vector<Vec3> joints;                        ///< of the segments, as in the rig
  std::vector<std::vector<RigidMotion>> segments;  ///< [frame][segment]: takes the mesh at rest to where it is

  // TRC only: the markers glued on landmarks
  RigidMotion rest;                       ///< takes the mesh to where it stands in the rest frame
  std::vector<std::string> marker_names;  ///< all of the file
  Eigen::MatrixXd marker_moves;           ///< #frames by 3 #markers: from its place in the rest frame; NaN: not seen

  Index frame_count() const { return static_cast<Index>(segments.size()); }
};

/// Reads `motion_file` in the rig's format and moves the rig with it. Throws Error(io), Error(bad_input): a joint or a
/// marker that the rig names is not in the file, a segment of no length, markers unseen for too long.
SkeletonMotion read_skeleton_motion(const Rig& rig, const std::filesystem::path& motion_file);

/// The rig moved by a skeleton of joints. With F = (proximal -> distal, flexion axis made perpendicular, their cross
/// product), R(t) = A F_motion(t) F_mesh^T, A the rotation to the axes of the mesh: the file's rest pose plays no part.
/// Translations are chained through the segments' joints; the root's follows its proximal joint, scaled, with the
/// height above the ground kept and the first frame at its place along the ground.
SkeletonMotion move_by_joints(const Rig& rig, const BvhMotion& motion);

/// The rig moved by markers: least-squares rigid fits against the rest frame. The similarity that takes the rig's
/// placement points of the mesh to the laboratory carries the mesh there; the result comes back by the rig's axes and
/// the inverse scale. Heights above the ground are kept, along the ground the root's joint starts at its place.
SkeletonMotion move_by_markers(const Rig& rig, const TrcMotion& motion);

/// The same motion from `from` to `to` seconds (of the motion file) at `frames_per_second` (0: as it is). Between
/// frames every segment turns about its joint against its parent, along the shortest arc; the root's joint goes
/// straight. Throws Error(usage) when nothing is left, and for more than a million frames.
SkeletonMotion resampled(const SkeletonMotion& motion, double frames_per_second,
                         double from = -std::numeric_limits<double>::infinity(),
                         double to = std::numeric_limits<double>::infinity());

/// The motion a fraction `s` of the way from `a` to `b`, s in [0, 1]: the rotation along the shortest arc, the image of
/// the point `about` on a straight line.
RigidMotion between(const RigidMotion& a, const RigidMotion& b, double s, const Vec3& about);

/// A motion without frames yet, for the segments of `rig`.
SkeletonMotion skeleton_of(const Rig& rig, double frames_per_second, double first_time);
/// Shifts all frames along the ground so that the root's joint is at its rest place in the first one.
void start_in_place(const Rig& rig, SkeletonMotion& motion);

}  // namespace skinbem
