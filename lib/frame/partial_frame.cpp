// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/frame/partial_frame.hpp>

#include <algorithm>
#include <string>

#include <skinbem/base/error.hpp>
#include <skinbem/frame/frame_factors.hpp>

namespace skinbem {

PartialFrame::PartialFrame(const FrameModel& model, Index most)
    : model_(&model),
      moving_(static_cast<std::size_t>(std::max<Index>(most, 0))),
      panels_(static_cast<std::size_t>(model.vertex_count()), 3 * moving_.size()),
      weights_(3 * moving_.size(), 0.0F),
      all_weights_(detail::make_weights(static_cast<std::size_t>(3 * model.landmark_count()))),
      packed_weights_(detail::make_weights(model.weight_count())),
      positions_(static_cast<std::size_t>(3 * model.vertex_count())) {
  if (most < 1 || most > model.landmark_count()) {
    throw Error(ErrorCode::usage, "frame: room for " + std::to_string(most) + " moving landmarks of " +
                                      std::to_string(model.landmark_count()));
  }
  hold(FrameState(model), {});
}

bool PartialFrame::hold(const FrameState& state, std::span<const Index> moving) noexcept {
  if (&state.model() != model_ || moving.size() > moving_.size()) return false;
  for (std::size_t i = 0; i < moving.size(); ++i) {
    if (moving[i] < 0 || moving[i] >= model_->landmark_count()) return false;
    if (std::find(moving.begin(), moving.begin() + static_cast<std::ptrdiff_t>(i), moving[i]) !=
        moving.begin() + static_cast<std::ptrdiff_t>(i)) {
      return false;
    }
  }
  std::copy(moving.begin(), moving.end(), moving_.begin());
  count_ = static_cast<Index>(moving.size());
  rigid_ = state.motion().rigid;
  sum_of_others(state);
  panels_.set_columns(3 * moving.size());
  detail::repeat_rigid(rigid_, model_->packing_centre(), factors_);
  return true;
}

void PartialFrame::sum_of_others(const FrameState& state) noexcept {
  const detail::FrameTarget target = model_->target(positions_.data(), 3);
  detail::FrameFactors frame{};
  detail::repeat_rigid({}, Vec3::Zero(), frame);
  frame.weights = packed_weights_.data();
  const auto evaluate = [&] {
    frame.weight_limit = model_->packed_weights(all_weights_.data(), packed_weights_.data());
    model_->product(&frame, &target, 1);
  };
  const Eigen::VectorXd& q = state.motion().weights;
  for (Index k = 0; k < q.size(); ++k) all_weights_[std::size_t(k)] = static_cast<float>(q[k]);
  for (std::size_t c = 0; c < 3 * static_cast<std::size_t>(count_); ++c) {
    const auto column = static_cast<std::size_t>(3 * moving_[c / 3]) + c % 3;
    weights_[c] = all_weights_[column];
    all_weights_[column] = 0;
  }
  evaluate();
  panels_.set_rest(positions_);
  // A column by itself is the frame of its unit weight without rest positions, however R is stored.
  frame.rest = 0;
  std::fill(all_weights_.begin(), all_weights_.end(), 0.0F);
  for (std::size_t c = 0; c < 3 * static_cast<std::size_t>(count_); ++c) {
    float& weight = all_weights_[static_cast<std::size_t>(3 * moving_[c / 3]) + c % 3];
    weight = 1;
    evaluate();
    weight = 0;
    panels_.set_column(c, positions_);
  }
}

bool PartialFrame::set_landmarks(const Eigen::Ref<const Points>& displacements) noexcept {
  const double largest = model_->largest_weight_;
  if (displacements.rows() != count_ || !(displacements.array().abs() <= largest).all()) return false;
  const auto weight = [&](Index i) {
    return body_weight(model_->landmark_rest().row(moving_[static_cast<std::size_t>(i)]), displacements.row(i), rigid_,
                       model_->mode());
  };
  for (Index i = 0; i < count_; ++i) {
    if (!(weight(i).array().abs() <= largest).all()) return false;
  }
  for (Index i = 0; i < count_; ++i) {
    Eigen::Map<Eigen::Vector3f>(weights_.data() + 3 * i) = weight(i).cast<float>();
  }
  return true;
}

bool PartialFrame::evaluate(const VertexTarget& positions) const noexcept {
  const detail::PanelMatrix panels = panels_.matrix();
  if (!positions.holds(panels.vertices)) return false;
  detail::FrameFactors frame = factors_;
  frame.weights = weights_.data();
  const detail::FrameTarget target{positions.vertex(0), positions.stride};
  detail::panel_product(panels, 0, panels.panels(), &frame, &target, 1);
  return true;
}

}  // namespace skinbem
