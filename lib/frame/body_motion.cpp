// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/frame/body_motion.hpp>

#include <skinbem/base/rigid_fit.hpp>

namespace skinbem {

void split_motion(const Eigen::Ref<const Points>& landmark_rest, const Eigen::Ref<const Points>& displacements,
                  FrameMode mode, BodyMotion& motion) noexcept {
  motion.rigid = mode == FrameMode::corotated ? fit_rigid_displacement(landmark_rest, displacements) : RigidMotion{};
  for (Index k = 0; k < landmark_rest.rows(); ++k) {
    motion.weights.segment<3>(3 * k) = body_weight(landmark_rest.row(k), displacements.row(k), motion.rigid, mode);
  }
}

Points evaluate_reference(const Points& rest, const Eigen::MatrixXd& response, const BodyMotion& motion) {
  const Eigen::VectorXd displacement = response * motion.weights;
  const Points deformed = rest + Eigen::Map<const Points>(displacement.data(), rest.rows(), 3);
  return (deformed * motion.rigid.rotation.transpose()).rowwise() + motion.rigid.translation.transpose();
}

}  // namespace skinbem
