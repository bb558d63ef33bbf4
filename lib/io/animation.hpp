// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A skin that deforms and bones that move: what every animated output is written from.
#pragma once

#include <string>
#include <vector>

#include <skinbem/mesh/triangle_mesh.hpp>

namespace skinbem {

/// The skin of frame f is body[f](X + targets * weights.row(f)^T), X the rest vertices as one node-major vector. With
/// the response R as targets and the landmark displacements left after the rigid part as weights that is a frame of the
/// model itself, not an approximation of it.
struct SkinAnimation {
  TriangleMesh rest;
  Eigen::MatrixXd targets;                ///< 3 #V by #K: displacement of the skin by a unit of each weight
  std::vector<std::string> target_names;  ///< #K, such as `LE.x`
  std::vector<double> times;              ///< #F, seconds, strictly increasing
  Eigen::MatrixXd weights;                ///< #F by #K, unit of the mesh
  std::vector<RigidMotion> body;          ///< #F, the rigid part

  Index frame_count() const { return static_cast<Index>(times.size()); }
};

/// A rigid body that accompanies the skin: its vertices in frame f are motion[f](mesh.vertices).
struct MovingBone {
  std::string name;
  TriangleMesh mesh;                ///< at rest, in the coordinates of the skin
  std::vector<RigidMotion> motion;  ///< #F
};

/// Vertices of the skin in frame `f`, #V by 3.
Points skin_vertices(const SkinAnimation& skin, Index f);
/// All bones of frame `f` as one mesh, in the order given.
TriangleMesh bones_mesh(const std::vector<MovingBone>& bones, Index f);

/// Throws Error(usage) when there is no frame, sizes disagree or the times do not increase, and Error(numerical) when a
/// number is not finite: a frame with NaN is never written.
void validate(const SkinAnimation& skin, const std::vector<MovingBone>& bones);
/// Throws Error(numerical) "animation: `what` is not finite ..." where it is not; for what is rounded to float too.
void require_finite(bool finite, const std::string& what);

}  // namespace skinbem
