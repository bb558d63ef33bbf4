// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/io/animation.hpp>

#include <cmath>

#include <skinbem/base/error.hpp>

namespace skinbem {
namespace {

void require(bool holds, const std::string& what) {
  if (!holds) throw Error(ErrorCode::usage, "animation: " + what);
}

bool finite(const std::vector<RigidMotion>& motions) {
  for (const RigidMotion& motion : motions) {
    if (!motion.rotation.allFinite() || !motion.translation.allFinite()) return false;
  }
  return true;
}

Points moved(const Points& points, const RigidMotion& motion) {
  return (points * motion.rotation.transpose()).rowwise() + motion.translation.transpose();
}

}  // namespace

void require_finite(bool finite, const std::string& what) {
  if (!finite) throw Error(ErrorCode::numerical, "animation: " + what + " is not finite, nothing was written");
}

Points skin_vertices(const SkinAnimation& skin, Index f) {
  Points points = skin.rest.vertices;
  Eigen::Map<Eigen::VectorXd>(points.data(), points.size()) += skin.targets * skin.weights.row(f).transpose();
  return moved(points, skin.body[static_cast<std::size_t>(f)]);
}

TriangleMesh bones_mesh(const std::vector<MovingBone>& bones, Index f) {
  Index vertices = 0, triangles = 0;
  for (const MovingBone& bone : bones) {
    vertices += bone.mesh.vertex_count();
    triangles += bone.mesh.triangle_count();
  }
  TriangleMesh all{Points(vertices, 3), Triangles(triangles, 3)};
  vertices = triangles = 0;
  for (const MovingBone& bone : bones) {
    const Index v = bone.mesh.vertex_count(), t = bone.mesh.triangle_count();
    all.vertices.middleRows(vertices, v) = moved(bone.mesh.vertices, bone.motion[static_cast<std::size_t>(f)]);
    all.triangles.middleRows(triangles, t) = bone.mesh.triangles.array() + static_cast<std::int32_t>(vertices);
    vertices += v;
    triangles += t;
  }
  return all;
}

void validate(const SkinAnimation& skin, const std::vector<MovingBone>& bones) {
  const Index frames = skin.frame_count(), targets = skin.targets.cols();
  require(frames > 0, "there is no frame, give at least one");
  require(skin.targets.rows() == skin.rest.vertices.size(), "targets need three rows a vertex of the skin");
  require(static_cast<Index>(skin.target_names.size()) == targets, "each target needs a name");
  require(skin.weights.rows() == frames && skin.weights.cols() == targets, "weights must be frames by targets");
  require(static_cast<Index>(skin.body.size()) == frames, "each frame needs a rigid motion of the body");
  for (std::size_t f = 0; f < skin.times.size(); ++f) {
    require_finite(std::isfinite(skin.times[f]), "a time");
    require(f == 0 || skin.times[f] > skin.times[f - 1], "times must increase");
  }
  require_finite(skin.rest.vertices.allFinite() && skin.targets.allFinite(), "the skin");
  require_finite(skin.weights.allFinite() && finite(skin.body), "the motion of the skin");
  for (const MovingBone& bone : bones) {
    require(static_cast<Index>(bone.motion.size()) == frames, "bone " + bone.name + " needs a motion for each frame");
    require_finite(bone.mesh.vertices.allFinite() && finite(bone.motion), "bone " + bone.name);
  }
}

}  // namespace skinbem
