// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/motion/landmark_motion.hpp>

#include <algorithm>
#include <cmath>

#include <skinbem/base/error.hpp>

namespace skinbem {
namespace {

constexpr double longest_gap = 0.2;  // seconds without the marker that are bridged

[[noreturn]] void fail(const Rig& rig, const std::string& what) {
  throw Error(ErrorCode::bad_input, rig.path + ": " + what);
}

/// Column of the marker on each landmark in SkeletonMotion::marker_moves, or -1.
std::vector<Index> markers_of(const Rig& rig, const SkeletonMotion& skeleton, const std::vector<Landmark>& landmarks) {
  std::vector<Index> result;
  const auto& names = skeleton.marker_names;
  for (const Landmark& landmark : landmarks) {
    const auto named = rig.skin_markers.find(landmark.name);
    const std::string& name = named == rig.skin_markers.end() ? landmark.name : named->second;
    const auto found = std::find(names.begin(), names.end(), name);
    if (found == names.end() && named != rig.skin_markers.end()) {
      fail(rig, "the motion file has no marker '" + name + "', which [skin_markers] names for '" + landmark.name + "'");
    }
    result.push_back(found == names.end() ? -1 : 3 * (found - names.begin()));
  }
  return result;
}

/// The moves of one marker, with gaps bridged on straight lines.
Eigen::MatrixXd bridged_moves(const Rig& rig, const SkeletonMotion& skeleton, Index column) {
  Eigen::MatrixXd moves = skeleton.marker_moves.middleCols(column, 3);
  Index last = -1;
  for (Index f = 0; f < moves.rows(); ++f) {
    if (std::isnan(moves(f, 0))) continue;
    if (f > last + 1 && (last < 0 || static_cast<double>(f - last - 1) / skeleton.frames_per_second > longest_gap))
      break;
    for (Index g = last + 1; g < f; ++g) {
      const double s = static_cast<double>(g - last) / static_cast<double>(f - last);
      moves.row(g) = (1 - s) * moves.row(last) + s * moves.row(f);
    }
    last = f;
  }
  if (last + 1 < moves.rows()) {
    const double time = skeleton.first_time + static_cast<double>(last + 1) / skeleton.frames_per_second;
    fail(rig, "marker '" + skeleton.marker_names[column / 3] + "' is not seen from " + std::to_string(time) +
                  " s on, at an end of the motion or for too long; fill the gap or use the mode follow");
  }
  return moves;
}

/// (5): the artefact of length L along G.
Vec3 slide(const Vec3& G, double L, MotionMode mode, double mean) {
  const double size = mode == MotionMode::literal ? G.norm() : std::hypot(G.norm(), mean);
  return size > 0 ? Vec3(L / size * G) : Vec3::Zero();
}

void check(const Rig& rig, const std::vector<Landmark>& landmarks, const Points& positions, MotionMode mode,
           const SkeletonMotion& skeleton) {
  if (positions.rows() != std::ssize(landmarks)) {
    throw Error(ErrorCode::usage, "landmark_motion: one rest position per landmark is needed");
  }
  if (mode == MotionMode::markers && skeleton.marker_names.empty()) {
    fail(rig, "the mode markers needs a motion file with markers (TRC)");
  }
  for (const Landmark& landmark : landmarks) {
    if (mode != MotionMode::literal || landmark.bone_point) continue;
    throw Error(ErrorCode::bad_input,
                "landmark '" + landmark.name +
                    "' has no bone point, which the mode literal needs; give bone_x, bone_y, bone_z");
  }
}

}  // namespace

std::vector<Index> segments_of(const Rig& rig, const std::vector<Landmark>& landmarks) {
  std::vector<Index> result;
  for (const Landmark& landmark : landmarks) {
    Index segment = landmark.bone.empty() ? -1 : rig.segment_of_bone(landmark.bone);
    for (std::size_t s = 0; s < rig.segments.size(); ++s) {
      const std::vector<std::string>& listed = rig.segments[s].landmarks;
      if (std::count(listed.begin(), listed.end(), landmark.name)) segment = static_cast<Index>(s);
    }
    if (segment < 0) {
      fail(rig, "no segment moves landmark '" + landmark.name + "'" +
                    (landmark.bone.empty() ? "" : " or its bone '" + landmark.bone + "'") +
                    "; add it to the 'landmarks' or 'bones' of a segment");
    }
    result.push_back(segment);
  }
  for (const RigSegment& segment : rig.segments) {
    for (const std::string& name : segment.landmarks) {
      const auto named = [&](const Landmark& landmark) { return landmark.name == name; };
      if (std::any_of(landmarks.begin(), landmarks.end(), named)) continue;
      fail(rig, "segment '" + segment.name + "' lists landmark '" + name + "', which the landmarks file does not have");
    }
  }
  return result;
}

LandmarkMotion landmark_motion(const Rig& rig, SkeletonMotion skeleton, const std::vector<Landmark>& landmarks,
                               const Points& positions, MotionMode mode, const ArtefactOptions& artefact) {
  artefact.validate();
  check(rig, landmarks, positions, mode, skeleton);
  LandmarkMotion result;
  result.segments = segments_of(rig, landmarks);
  result.displacements.resize(skeleton.frame_count(), 3 * positions.rows());
  std::vector<Index> markers(landmarks.size(), -1);
  if (mode == MotionMode::markers) markers = markers_of(rig, skeleton, landmarks);

  for (Index k = 0; k < positions.rows(); ++k) {
    const Landmark& landmark = landmarks[k];
    const Vec3 p = positions.row(k).transpose();
    Eigen::MatrixXd moves;
    if (markers[k] >= 0) moves = bridged_moves(rig, skeleton, markers[k]);
    if (mode == MotionMode::markers && markers[k] < 0) result.unmarked.push_back(landmark.name);
    for (Index f = 0; f < skeleton.frame_count(); ++f) {
      const RigidMotion& bone = skeleton.segments[f][result.segments[k]];
      Vec3 G = bone(p) - p;
      if (mode == MotionMode::literal) G = p - bone(*landmark.bone_point);
      if (markers[k] >= 0) G = skeleton.rest(p) - p + moves.row(f).transpose();
      const double time = skeleton.first_time + static_cast<double>(f) / skeleton.frames_per_second;
      const double L = artefact_length(artefact, k, f, time);
      result.displacements.row(f).segment<3>(3 * k) = (G + slide(G, L, mode, artefact.mean)).transpose();
    }
  }
  result.skeleton = std::move(skeleton);
  return result;
}

}  // namespace skinbem
