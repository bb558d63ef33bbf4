// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A frame in which few landmarks move costs only their columns.
#pragma once

#include <span>
#include <vector>

#include <skinbem/frame/column_panels.hpp>
#include <skinbem/frame/frame_model.hpp>

namespace skinbem {

/// A character of which only some landmarks move for a while, such as a face that talks: what the others contribute is
/// summed once and kept, and a frame reads that sum and the columns of those that move.
///
/// (Q, t) stays what it was when the others were held: with a new best fit every q_k would change, and with it every
/// column. In `linear` mode the frame is FrameState's; in `corotated` mode it is R's answer in the held body frame.
///
/// Bits: a frame depends on the model, the held pose, the landmarks that move and where they are now, not on the frames
/// between; nothing drifts. It differs from FrameState's in the last digits of single precision, as the sum has another
/// order.
///
/// After construction nothing allocates, locks or throws. Refers to its model, which must outlive it.
class PartialFrame {
 public:
  /// Room for `most` landmarks that move at once. Throws Error(usage) unless 1 <= most <= #K.
  PartialFrame(const FrameModel& model, Index most);

  /// The pose of `state` from now on, of which only the landmarks `moving` will move. Costs 1 + 3 #moving frames.
  /// Returns false and changes nothing where the state is of another model, or `moving` has more than there is room
  /// for, a number that is no landmark, or one twice.
  bool hold(const FrameState& state, std::span<const Index> moving) noexcept;

  /// Displacements u_k of the moving landmarks, in the order of hold, mesh frame: #moving by 3. Returns false, and
  /// keeps the pose as it was, under the conditions of FrameState::set_landmarks.
  bool set_landmarks(const Eigen::Ref<const Points>& displacements) noexcept;

  /// As FrameState::evaluate: always finite. At rest before the first hold.
  bool evaluate(const VertexTarget& positions) const noexcept;

 private:
  void sum_of_others(const FrameState& state) noexcept;

  const FrameModel* model_;
  RigidMotion rigid_;          ///< held
  std::vector<Index> moving_;  ///< with room for most
  Index count_ = 0;
  detail::ColumnPanels panels_;                  ///< sum of the others, and the moving landmarks' columns
  std::vector<float> weights_;                   ///< of the columns in panels_
  detail::AlignedVector<float> all_weights_;     ///< q, while columns are summed
  detail::AlignedVector<float> packed_weights_;  ///< what the model makes of it
  std::vector<float> positions_;                 ///< of a frame that goes into panels_
  detail::FrameFactors factors_;
};

}  // namespace skinbem
