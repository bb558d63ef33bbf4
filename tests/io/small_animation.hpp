// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A small skin with bones that move: what the writers are tested on.
#pragma once

#include <Eigen/Geometry>

#include <skinbem/io/animation.hpp>

namespace skinbem::testing_support {

inline TriangleMesh octahedron(double radius) {
  TriangleMesh mesh{Points(6, 3), Triangles(8, 3)};
  mesh.vertices << 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1, 0, 0, 0, 1, 0, 0, -1;
  mesh.vertices *= radius;
  mesh.triangles << 0, 2, 4, 2, 1, 4, 1, 3, 4, 3, 0, 4, 2, 0, 5, 1, 2, 5, 3, 1, 5, 0, 3, 5;
  return mesh;
}

/// Turns by more than a whole turn over 40 frames, so that quaternions have to change sign to stay continuous.
inline RigidMotion turned(double s) {
  return {Eigen::AngleAxisd(0.2 * s, Vec3(1, 2, 3).normalized()).toRotationMatrix(), Vec3(10 * s, -3 * s, 400 + s)};
}

inline SkinAnimation small_skin(Index frames, Index targets = 6) {
  SkinAnimation skin;
  skin.rest = octahedron(100);
  skin.targets.resize(18, targets);
  skin.weights.resize(frames, targets);
  for (Index k = 0; k < targets; ++k) {
    skin.target_names.push_back(std::to_string(k / 3) + "xyz"[k % 3]);
    for (Index i = 0; i < 18; ++i) skin.targets(i, k) = std::sin(1.0 + static_cast<double>(3 * i + 7 * k));
    for (Index f = 0; f < frames; ++f) skin.weights(f, k) = 5 * std::cos(static_cast<double>(f + k));
  }
  for (Index f = 0; f < frames; ++f) {
    skin.times.push_back(0.25 + 0.01 * static_cast<double>(f));
    skin.body.push_back(turned(static_cast<double>(f)));
  }
  return skin;
}

inline std::vector<MovingBone> small_bones(Index frames) {
  std::vector<MovingBone> bones{{"tibia", octahedron(20), {}}, {"talus", octahedron(10), {}}};
  for (Index f = 0; f < frames; ++f) {
    bones[0].motion.push_back(turned(0.5 * static_cast<double>(f)));
    bones[1].motion.push_back(turned(-1.5 * static_cast<double>(f)));
  }
  return bones;
}

}  // namespace skinbem::testing_support
