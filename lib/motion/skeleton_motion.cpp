// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/motion/skeleton_motion.hpp>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include <skinbem/base/error.hpp>

namespace skinbem {
namespace {

constexpr int most_frames = 1'000'000;  // hours of motion; the files of a sequence are numbered with six digits

/// Frame `f` and the fraction towards the next one.
struct Moment {
  Index frame;
  double fraction;
};

std::vector<RigidMotion> segments_at(const SkeletonMotion& motion, Moment moment) {
  const std::vector<RigidMotion>& a = motion.segments[moment.frame];
  if (moment.fraction == 0) return a;
  const std::vector<RigidMotion>& b = motion.segments[moment.frame + 1];
  std::vector<RigidMotion> result;
  for (std::size_t s = 0; s < a.size(); ++s) {
    const Index parent = motion.parents[s];
    if (parent < 0) {
      result.push_back(between(a[s], b[s], moment.fraction, motion.joints[s]));
    } else {
      result.push_back(result[parent] * between(a[parent].inverse() * a[s], b[parent].inverse() * b[s], moment.fraction,
                                                motion.joints[s]));
    }
  }
  return result;
}

Eigen::RowVectorXd markers_at(const SkeletonMotion& motion, Moment moment) {
  const auto& moves = motion.marker_moves;
  if (moment.fraction == 0) return moves.row(moment.frame);
  return (1 - moment.fraction) * moves.row(moment.frame) + moment.fraction * moves.row(moment.frame + 1);
}

}  // namespace

RigidMotion between(const RigidMotion& a, const RigidMotion& b, double s, const Vec3& about) {
  if (s == 0) return a;
  if (s == 1) return b;
  RigidMotion result;
  result.rotation = Eigen::Quaterniond(a.rotation).slerp(s, Eigen::Quaterniond(b.rotation)).toRotationMatrix();
  result.translation = (1 - s) * a(about) + s * b(about) - result.rotation * about;
  return result;
}

SkeletonMotion skeleton_of(const Rig& rig, double frames_per_second, double first_time) {
  SkeletonMotion result;
  result.frames_per_second = frames_per_second;
  result.first_time = first_time;
  for (const RigSegment& segment : rig.segments) {
    result.segment_names.push_back(segment.name);
    result.parents.push_back(segment.parent);
    result.joints.push_back(segment.joint);
  }
  return result;
}

SkeletonMotion read_skeleton_motion(const Rig& rig, const std::filesystem::path& motion_file) {
  return rig.format == MotionFormat::bvh ? move_by_joints(rig, read_bvh(motion_file))
                                         : move_by_markers(rig, read_trc(motion_file));
}

SkeletonMotion resampled(const SkeletonMotion& motion, double frames_per_second, double from, double to) {
  const double rate = frames_per_second > 0 ? frames_per_second : motion.frames_per_second;
  const double last_time = motion.first_time + static_cast<double>(motion.frame_count() - 1) / motion.frames_per_second;
  const double begin = std::max(from, motion.first_time), end = std::min(to, last_time);
  if (!(begin <= end)) {
    throw Error(ErrorCode::usage, "no frame lies between " + std::to_string(from) + " and " + std::to_string(to) +
                                      " s, the motion goes from " + std::to_string(motion.first_time) + " to " +
                                      std::to_string(last_time) + " s");
  }
  const double slack = 1e-6;  // of a frame: times are sums of rounded steps
  const double steps = std::floor((end - begin) * rate + slack);
  if (!(steps < most_frames)) {
    throw Error(ErrorCode::usage, "more than " + std::to_string(most_frames) +
                                      " frames, ask for fewer a second or for a shorter part of the motion");
  }
  SkeletonMotion result = motion;
  result.frames_per_second = rate;
  result.first_time = begin;
  result.segments.clear();
  const Index count = static_cast<Index>(steps) + 1;
  result.marker_moves.resize(count, motion.marker_moves.cols());
  for (Index i = 0; i < count; ++i) {
    double at = (begin - motion.first_time + static_cast<double>(i) / rate) * motion.frames_per_second;
    if (std::abs(at - std::round(at)) < slack) at = std::round(at);  // frames of the file come through as they are
    at = std::clamp(at, 0.0, static_cast<double>(motion.frame_count() - 1));
    const Moment moment{static_cast<Index>(at), at - std::floor(at)};
    result.segments.push_back(segments_at(motion, moment));
    if (motion.marker_moves.cols() > 0) result.marker_moves.row(i) = markers_at(motion, moment);
  }
  return result;
}

void start_in_place(const Rig& rig, SkeletonMotion& motion) {
  Vec3 shift = rig.segments[0].joint - motion.segments[0][0](rig.segments[0].joint);
  shift -= rig.mesh_up * rig.mesh_up.dot(shift);
  for (std::vector<RigidMotion>& frame : motion.segments) {
    for (RigidMotion& segment : frame) segment.translation += shift;
  }
  motion.rest.translation += shift;
}

}  // namespace skinbem
