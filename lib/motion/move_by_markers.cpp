// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <cmath>

#include <skinbem/base/error.hpp>
#include <skinbem/base/rigid_fit.hpp>
#include <skinbem/motion/skeleton_motion.hpp>

namespace skinbem {
namespace {

constexpr double least_spread = 0.02;     // collinear_measure below which points count as lying on a line
constexpr double worst_placement = 0.25;  // residual of the placement, of the points' spread: beyond, they are mixed up
constexpr double longest_gap = 0.2;       // seconds without enough markers that are bridged

/// laboratory = scale rotation mesh + translation
struct Similarity {
  double scale;
  Mat3 rotation;
  Vec3 translation;
};

[[noreturn]] void fail(const Rig& rig, const std::string& what) {
  throw Error(ErrorCode::bad_input, rig.path + ": " + what);
}

Index marker_called(const Rig& rig, const TrcMotion& motion, const std::string& name) {
  const Index marker = motion.find(name);
  if (marker >= 0) return marker;
  std::string names;
  for (const std::string& known : motion.markers) names += " " + known;
  fail(rig, "the motion file has no marker '" + name + "'; it has" + names);
}

Index rest_frame(const Rig& rig, const TrcMotion& motion) {
  const double frame = std::round((rig.rest_time - motion.first_time) * motion.rate);
  if (frame >= 0 && frame < static_cast<double>(motion.frame_count())) return static_cast<Index>(frame);
  fail(rig, "'rest_time' " + std::to_string(rig.rest_time) + " s lies outside the motion file");
}

Vec3 seen_at_rest(const Rig& rig, const TrcMotion& motion, const std::string& name) {
  const std::optional<Vec3> position = motion.position(rest_frame(rig, motion), marker_called(rig, motion, name));
  if (!position) fail(rig, "marker '" + name + "' is not seen in the rest frame, choose another 'rest_time'");
  return *position;
}

/// The best similarity: the rotation does not depend on the scale (Umeyama 1991).
Similarity place(const Rig& rig, const TrcMotion& motion) {
  const Index count = std::ssize(rig.placement);
  Points mesh(count, 3), laboratory(count, 3);
  for (Index i = 0; i < count; ++i) {
    const Placement& placement = rig.placement[i];
    mesh.row(i) = placement.mesh.transpose();
    const std::string* const marker = std::get_if<std::string>(&placement.laboratory);
    laboratory.row(i) =
        (marker ? seen_at_rest(rig, motion, *marker) : std::get<Vec3>(placement.laboratory)).transpose();
  }
  Similarity result{0, fit_rigid(mesh, laboratory).rotation, Vec3::Zero()};
  const Vec3 from = mesh.colwise().mean(), to = laboratory.colwise().mean();
  const Points turned = (mesh.rowwise() - from.transpose()) * result.rotation.transpose();
  const Points wanted = laboratory.rowwise() - to.transpose();
  result.scale = turned.cwiseProduct(wanted).sum() / turned.squaredNorm();
  result.translation = to - result.scale * (result.rotation * from);
  if (!(result.scale > 0) || (result.scale * turned - wanted).norm() > worst_placement * wanted.norm()) {
    fail(rig,
         "the points of [placement] are not arranged alike in the mesh and in the laboratory, check their order and "
         "axes");
  }
  return result;
}

/// Every frame's rigid motion of a segment in the laboratory; nothing where too few of its markers are seen.
std::vector<std::optional<RigidMotion>> fits(const Rig& rig, const RigSegment& segment, const TrcMotion& motion) {
  const Index count = std::ssize(segment.markers);
  std::vector<Index> markers;
  Points rest(count, 3);
  for (Index i = 0; i < count; ++i) {
    markers.push_back(marker_called(rig, motion, segment.markers[i]));
    rest.row(i) = seen_at_rest(rig, motion, segment.markers[i]).transpose();
  }
  if (collinear_measure(rest) < least_spread) {
    fail(rig, "the markers of segment '" + segment.name + "' lie on a line, add one beside it");
  }
  std::vector<std::optional<RigidMotion>> result;
  Points from(count, 3), to(count, 3);
  for (Index frame = 0; frame < motion.frame_count(); ++frame) {
    Index seen = 0;
    for (Index i = 0; i < count; ++i) {
      const std::optional<Vec3> position = motion.position(frame, markers[i]);
      if (!position) continue;
      from.row(seen) = rest.row(i);
      to.row(seen++) = position->transpose();
    }
    const bool enough = seen >= 3 && collinear_measure(from.topRows(seen)) >= least_spread;
    result.push_back(enough ? std::optional(fit_rigid(from.topRows(seen), to.topRows(seen))) : std::nullopt);
  }
  return result;
}

/// Fills frames without a motion from those before and after.
std::vector<RigidMotion> bridged(const Rig& rig, const RigSegment& segment, const TrcMotion& motion,
                                 const std::vector<std::optional<RigidMotion>>& known) {
  std::vector<RigidMotion> result;
  Index last = -1;
  for (Index frame = 0; frame < std::ssize(known); ++frame) {
    if (!known[frame]) continue;
    const double seconds = static_cast<double>(frame - last - 1) / motion.rate;
    if (frame > last + 1 && (last < 0 || seconds > longest_gap)) break;
    for (Index f = last + 1; f < frame; ++f) {
      const double s = static_cast<double>(f - last) / static_cast<double>(frame - last);
      result.push_back(between(*known[last], *known[frame], s, segment.joint));
    }
    result.push_back(*known[frame]);
    last = frame;
  }
  if (std::ssize(result) < std::ssize(known)) {
    const double time = motion.first_time + static_cast<double>(last + 1) / motion.rate;
    fail(rig, "too few markers of segment '" + segment.name + "' are seen from " + std::to_string(time) +
                  " s on, at an end of the file or for longer than " + std::to_string(longest_gap) +
                  " s; fill the gap in the motion file, or name more markers");
  }
  return result;
}

}  // namespace

SkeletonMotion move_by_markers(const Rig& rig, const TrcMotion& motion) {
  const Similarity placed = place(rig, motion);
  const Vec3 ground = rig.mesh_up * (rig.mesh_floor - rig.motion_floor / placed.scale);
  // The motion of the mesh whose image in the laboratory moves by `in_laboratory`.
  const auto of_mesh = [&](const RigidMotion& in_laboratory) {
    return RigidMotion{rig.axes * in_laboratory.rotation * placed.rotation,
                       rig.axes * in_laboratory(placed.translation) / placed.scale + ground};
  };

  SkeletonMotion result = skeleton_of(rig, motion.rate, motion.first_time);
  result.segments.assign(static_cast<std::size_t>(motion.frame_count()), {});
  for (const RigSegment& segment : rig.segments) {
    std::vector<std::optional<RigidMotion>> known = fits(rig, segment, motion);
    for (std::optional<RigidMotion>& fit : known) {
      if (fit) fit = of_mesh(*fit);
    }
    const std::vector<RigidMotion> moved = bridged(rig, segment, motion, known);
    for (std::size_t f = 0; f < moved.size(); ++f) {
      RigidMotion now = moved[f];
      if (rig.chained && segment.parent >= 0) {
        now.translation = result.segments[f][segment.parent](segment.joint) - now.rotation * segment.joint;
      }
      result.segments[f].push_back(now);
    }
  }

  result.rest = of_mesh(RigidMotion());
  result.marker_names = motion.markers;
  const Index rest = rest_frame(rig, motion);
  result.marker_moves.resize(motion.frame_count(), motion.positions.cols());
  for (Index f = 0; f < motion.frame_count(); ++f) {
    for (Index m = 0; m < motion.positions.cols(); m += 3) {
      const Eigen::RowVector3d moved = motion.positions.row(f).segment<3>(m) - motion.positions.row(rest).segment<3>(m);
      result.marker_moves.row(f).segment<3>(m) = moved * rig.axes.transpose() / placed.scale;
    }
  }
  start_in_place(rig, result);
  return result;
}

}  // namespace skinbem
