// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Small models for the tests of frames: not physical, but with what every response matrix has.
#pragma once

#include <cstdlib>

#include <Eigen/Geometry>

#include <skinbem/frame/frame_model.hpp>

namespace skinbem::testing_support {

struct SyntheticSkin {
  Points rest;
  Points landmarks;
  Eigen::MatrixXd response;
};

/// Vertices scattered over a 300 mm leg that stands 800 mm from the origin; each follows the landmarks by weights that
/// fall with the distance and sum to one, plus a coupling between x, y and z that vanishes for a common translation.
inline SyntheticSkin synthetic_skin(Index vertices, Index landmarks) {
  std::srand(7);
  SyntheticSkin skin;
  const Eigen::RowVector3d size(60, 50, 150);
  const Eigen::RowVector3d place(100, -40, 800);
  skin.rest = (Points::Random(vertices, 3) * size.asDiagonal()).rowwise() + place;
  skin.landmarks = (Points::Random(landmarks, 3) * size.asDiagonal()).rowwise() + place;
  skin.response.resize(3 * vertices, 3 * landmarks);
  for (Index i = 0; i < vertices; ++i) {
    Eigen::VectorXd weight(landmarks);
    for (Index k = 0; k < landmarks; ++k) {
      weight(k) = 1 / (1 + (skin.rest.row(i) - skin.landmarks.row(k)).squaredNorm() / 1600);
    }
    weight /= weight.sum();
    const Eigen::VectorXd coupling = weight.array() - weight.mean();
    for (Index k = 0; k < landmarks; ++k) {
      skin.response.block<3, 3>(3 * i, 3 * k) =
          weight(k) * Mat3::Identity() + 0.3 * (coupling(k) - coupling.mean()) * Mat3::Ones();
    }
  }
  return skin;
}

/// Displacements that carry the landmarks rigidly: motion(p) - p.
inline Points rigid_displacements(const Points& landmarks, const RigidMotion& motion) {
  Points result(landmarks.rows(), 3);
  for (Index k = 0; k < landmarks.rows(); ++k) {
    result.row(k) = motion(landmarks.row(k).transpose()).transpose() - landmarks.row(k);
  }
  return result;
}

inline RigidMotion some_motion(double angle) {
  return {Eigen::AngleAxisd(angle, Vec3(1, -2, 0.5).normalized()).toRotationMatrix(), {35, -70, 12}};
}

/// The frame of `state` as #V by 3.
inline Points evaluated(const FrameState& state) {
  std::vector<float> positions(static_cast<std::size_t>(3 * state.model().vertex_count()));
  EXPECT_TRUE(state.evaluate(positions));
  Points result(state.model().vertex_count(), 3);
  for (Index i = 0; i < result.size(); ++i) result.data()[i] = double{positions[static_cast<std::size_t>(i)]};
  return result;
}

}  // namespace skinbem::testing_support
