// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>

#include <skinbem/base/error.hpp>
#include <skinbem/motion/skeleton_motion.hpp>

namespace skinbem {
namespace {

/// Which joints of the file are at the ends of a segment.
struct Ends {
  Index proximal, distal;
};

[[noreturn]] void fail(const Rig& rig, const RigSegment& segment, const std::string& what) {
  throw Error(ErrorCode::bad_input, rig.path + ": segment '" + segment.name + "': " + what);
}

Ends ends_of(const Rig& rig, const RigSegment& segment, const BvhMotion& motion) {
  const Ends ends{motion.find(segment.proximal_joint), motion.find(segment.distal_joint)};
  if (ends.proximal >= 0 && ends.distal >= 0) return ends;
  std::string names;
  for (const BvhJoint& joint : motion.joints) names += " " + joint.name;
  fail(rig, segment,
       "the motion file has no joint '" + (ends.proximal < 0 ? segment.proximal_joint : segment.distal_joint) +
           "'; it has" + names);
}

/// The rotation whose columns are the direction of `along`, of `axis` made perpendicular to it, and their cross
/// product. Not a number when the two are parallel or one is zero.
Mat3 frame(const Vec3& along, const Vec3& axis) {
  Mat3 result;
  result.col(0) = along / along.norm();
  const Vec3 across = axis - result.col(0) * result.col(0).dot(axis);
  result.col(1) = across / across.norm();
  result.col(2) = result.col(0).cross(result.col(1));
  return result;
}

/// Mesh units per unit of the motion file.
double scale_of(const Rig& rig, const std::vector<Ends>& ends, const std::vector<RigidMotion>& first) {
  if (rig.scale) return *rig.scale;
  std::size_t s = 0;
  while (rig.segments[s].name != rig.scale_segment) ++s;
  const RigSegment& segment = rig.segments[s];
  const double length = (first[ends[s].distal].translation - first[ends[s].proximal].translation).norm();
  if (!(length > 0)) fail(rig, segment, "has no length in the motion file, so no scale follows from it");
  return (segment.distal - segment.proximal).norm() / length;
}

}  // namespace

SkeletonMotion move_by_joints(const Rig& rig, const BvhMotion& motion) {
  std::vector<Ends> ends;
  for (const RigSegment& segment : rig.segments) ends.push_back(ends_of(rig, segment, motion));
  const double scale = scale_of(rig, ends, joint_poses(motion, 0));

  SkeletonMotion result = skeleton_of(rig, 1 / motion.frame_time, 0);
  for (Index f = 0; f < motion.frame_count(); ++f) {
    const std::vector<RigidMotion> poses = joint_poses(motion, f);
    std::vector<RigidMotion> moved;
    for (std::size_t s = 0; s < rig.segments.size(); ++s) {
      const RigSegment& segment = rig.segments[s];
      const RigidMotion& joint = poses[ends[s].proximal];
      const Mat3 in_motion =
          frame(poses[ends[s].distal].translation - joint.translation, joint.rotation * segment.motion_axis);
      const Mat3 in_mesh = frame(segment.distal - segment.proximal, segment.axis);
      RigidMotion now{rig.axes * in_motion * in_mesh.transpose(), Vec3::Zero()};
      if (!now.rotation.allFinite()) {
        fail(rig, segment, "in frame " + std::to_string(f + 1) + " its ends coincide or 'motion_axis' lies along it");
      }
      if (segment.parent < 0) {
        const Vec3 ground = rig.mesh_up * (rig.mesh_floor - scale * rig.motion_floor);
        now.translation = scale * (rig.axes * joint.translation) + ground - now.rotation * segment.proximal;
      } else {
        now.translation = moved[segment.parent](segment.joint) - now.rotation * segment.joint;
      }
      moved.push_back(now);
    }
    result.segments.push_back(std::move(moved));
  }
  start_in_place(rig, result);
  return result;
}

}  // namespace skinbem
