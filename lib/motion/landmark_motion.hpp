// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// From the motion of the bones to the displacement of the landmarks: equations (3) to (5).
///
///     u_k = G_k + L_k   (3)        G_k from the bone's motion (R, T)   (4)        L_k = L G_k / |G_k|   (5)
#pragma once

#include <skinbem/motion/artefact.hpp>
#include <skinbem/motion/skeleton_motion.hpp>
#include <skinbem/response/landmark.hpp>

namespace skinbem {

enum class MotionMode {
  /// G = (R p + T) - p: the landmark's rest position p goes with its bone. It is (4) with the offset of skin and bone
  /// point
  /// turned with the bone, and zero at rest.
  follow,
  /// G = v - (R v^ + T), (4) as printed, from the moved bone point v^ to the rest position v of the skin. Not zero at
  /// rest.
  /// L_k is (5) as printed: L G / |G| (0 where G is 0). For comparison with the paper.
  literal,
  /// G is the measured motion of a marker on the landmark; landmarks without a marker follow their bone.
  markers,
};

struct LandmarkMotion {
  SkeletonMotion skeleton;            ///< where the bones are, frame by frame
  Eigen::MatrixXd displacements;      ///< #frames by 3 Nk: u_k, landmark-major x, y, z, unit of the mesh
  std::vector<Index> segments;        ///< Nk: the segment of each landmark
  std::vector<std::string> unmarked;  ///< mode markers: the landmarks without a marker
};

/// The segment that each landmark follows: the one whose `landmarks` list it, else that of its bone.
/// Throws Error(bad_input) for a landmark without a segment, and for a listed landmark that `landmarks` does not have.
std::vector<Index> segments_of(const Rig& rig, const std::vector<Landmark>& landmarks);

/// u_k of all landmarks in all frames of `skeleton`, made by `rig`. `positions` (Nk by 3) are the landmarks' rest
/// positions p_k = m_k(X), the same weighted means of vertices that the response prescribes. Except in `literal`, the
/// direction of L_k is G / sqrt(|G|^2 + mean^2), which fades in smoothly from rest. In `literal` every landmark needs a
/// bone_point. Throws Error(bad_input) as segments_of, for a missing bone_point, for a landmark's marker that is not
/// seen for more than 0.2 s or at either end; Error(usage) when shapes differ or options are out of range.
LandmarkMotion landmark_motion(const Rig& rig, SkeletonMotion skeleton, const std::vector<Landmark>& landmarks,
                               const Points& positions, MotionMode mode = MotionMode::follow,
                               const ArtefactOptions& artefact = {});

}  // namespace skinbem
