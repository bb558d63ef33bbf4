// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The landmarks' displacements, split into the motion of the body and what deforms it.
#pragma once

#include <skinbem/base/types.hpp>

namespace skinbem {

/// How a frame treats the rigid part of the landmarks' motion.
enum class FrameMode {
  corotated,  ///< y = Q (X + R q) + t with the best rigid motion (Q, t) taken out: large rotations of the body are
              ///< exact
  linear,     ///< y = X + R u: Q = I, t = 0; the displacements enter as they are
};

/// (Q, t) and q of a frame y = Q (X + R q) + t.
struct BodyMotion {
  RigidMotion rigid;        ///< (Q, t): body frame to mesh frame
  Eigen::VectorXd weights;  ///< q, 3 #K, landmark-major x, y, z: one factor for each column of R

  /// At rest, with room for `landmark_count` landmarks.
  static BodyMotion at_rest(Index landmark_count) { return {{}, Eigen::VectorXd::Zero(3 * landmark_count)}; }
};

/// q_k = Q^T (p_k + u_k - t) - p_k of one landmark; u_k itself in `linear` mode, as p + u - p would lose its last bits.
inline Vec3 body_weight(const Vec3& p, const Vec3& u, const RigidMotion& rigid, FrameMode mode) noexcept {
  return mode == FrameMode::linear ? u : Vec3(rigid.rotation.transpose() * (p + u - rigid.translation) - p);
}

/// Splits `displacements` u (#K by 3, mesh frame) of landmarks at `landmark_rest` p (#K by 3): (Q, t) is the
/// least-squares rigid motion p -> p + u (identity in `linear` mode), q_k = Q^T (p_k + u_k - t) - p_k. `motion.weights`
/// holds 3 #K numbers already, so nothing is allocated.
void split_motion(const Eigen::Ref<const Points>& landmark_rest, const Eigen::Ref<const Points>& displacements,
                  FrameMode mode, BodyMotion& motion) noexcept;

/// The frame in double, for offline output and as the reference of the real-time path: #V by 3, Q (X + R q) + t for the
/// rest positions X (#V by 3) and R (3 #V by 3 #K, rows node-major, columns landmark-major, x, y, z).
Points evaluate_reference(const Points& rest, const Eigen::MatrixXd& response, const BodyMotion& motion);

}  // namespace skinbem
