// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/frame/frame_model.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <utility>

#include <skinbem/base/error.hpp>
#include <skinbem/base/rigid_fit.hpp>
#include <skinbem/frame/compression.hpp>
#include <skinbem/frame/frame_factors.hpp>
#include <skinbem/frame/reading_order.hpp>

namespace skinbem {
namespace {

/// Landmarks whose second extent is below this share of the first leave the rotation about their line to noise.
constexpr double kNearlyCollinear = 0.02;

std::string shape(const auto& matrix) { return std::to_string(matrix.rows()) + " by " + std::to_string(matrix.cols()); }

void check_shapes(const Points& rest, const Eigen::MatrixXd& response, const Points& landmark_rest) {
  if (rest.rows() == 0 || landmark_rest.rows() == 0) {
    throw Error(ErrorCode::usage, "frame: a skin needs at least one vertex and one landmark");
  }
  if (response.rows() != 3 * rest.rows() || response.cols() != 3 * landmark_rest.rows()) {
    throw Error(ErrorCode::usage,
                "frame: the response matrix is " + shape(response) + ", but " + std::to_string(rest.rows()) +
                    " vertices and " + std::to_string(landmark_rest.rows()) + " landmarks need " +
                    std::to_string(3 * rest.rows()) + " by " + std::to_string(3 * landmark_rest.rows()));
  }
}

void check_numbers(const char* name, const auto& matrix) {
  for (Index j = 0; j < matrix.cols(); ++j) {
    for (Index i = 0; i < matrix.rows(); ++i) {
      if (!(std::abs(matrix(i, j)) <= detail::kLargestNumber)) {
        throw Error(ErrorCode::bad_input, std::string("frame: ") + name + " has " + std::to_string(matrix(i, j)) +
                                              " at row " + std::to_string(i) + ", column " + std::to_string(j) +
                                              "; it must be finite and within the range of float");
      }
    }
  }
}

}  // namespace

void FrameOptions::validate() const {
  if (!(error_bound > 0) || !(motion_range > 0) || !std::isfinite(error_bound) || !std::isfinite(motion_range)) {
    throw Error(ErrorCode::usage, "frame: error bound and motion range must be positive lengths");
  }
}

FrameModel::FrameModel(const Points& rest, const Eigen::MatrixXd& response, const Points& landmark_rest,
                       const FrameOptions& options)
    : landmark_rest_(landmark_rest), options_(options) {
  options.validate();
  check_shapes(rest, response, landmark_rest);
  check_numbers("the rest position", rest);
  check_numbers("the response matrix", response);
  check_numbers("the landmark position", landmark_rest);
  centre_ = options.directions ? Vec3(Vec3::Zero()) : Vec3(rest.colwise().mean());
  largest_weight_ = detail::kLargestNumber / std::max(1.0, response.cwiseAbs().rowwise().sum().maxCoeff());
  const Points centred = rest.rowwise() - centre_.transpose();
  const double error_factor = options.error_bound / options.motion_range;
  switch (options.storage) {
    case FrameStorage::float32:
      packed_ = detail::pack_float32(centred, response);
      break;
    case FrameStorage::int16:
      packed_ = detail::pack_int16(centred, response, error_factor);
      break;
    case FrameStorage::compressed: {
      detail::CompressedPanels compressed = detail::compress(centred, response, error_factor);
      packed_ = std::move(compressed.basis);
      coordinates_ = std::move(compressed.coordinates);
      order_ = std::move(compressed.order);
      // |U z| is at most the sum of |z| over the coordinates of a patch, which are no more than the columns of R.
      largest_weight_ /= std::max(1.0, compressed.largest_row * static_cast<double>(response.cols()));
    }
  }
  const auto columns = static_cast<std::size_t>(response.cols());
  coordinates_.in_turns = detail::faster_in_turns(coordinates_.matrix(), coordinates_.data.size(), columns);
  packed_.in_turns = detail::faster_in_turns(packed_.matrix(), packed_.data.size(), weight_count());
  if (options.mode == FrameMode::corotated && collinear_measure(landmark_rest) < kNearlyCollinear) {
    warnings_.push_back(
        "the landmarks are nearly collinear, so the rotation of the body about their line is not determined: add a "
        "landmark off the line, or use the linear frame");
  }
}

std::size_t FrameModel::weight_count() const noexcept {
  return 3 * (coordinates_.vertices + static_cast<std::size_t>(landmark_count()));
}

float FrameModel::packed_weights(const float* q, float* weights) const noexcept {
  std::copy(q, q + 3 * landmark_count(), weights + 3 * coordinates_.vertices);
  const float limit = detail::weight_limit(q, static_cast<std::size_t>(3 * landmark_count()));
  if (coordinates_.vertices == 0) return limit;
  detail::FrameFactors frame{};
  frame.weights = q;
  frame.weight_limit = limit;
  detail::repeat_rigid({}, Vec3::Zero(), frame);
  const detail::FrameTarget target{weights};
  const detail::PanelMatrix coordinates = coordinates_.matrix();
  detail::panel_product(coordinates, 0, coordinates.panels(), &frame, &target, 1);
  return detail::weight_limit(weights, weight_count());
}

void FrameModel::product(const detail::FrameFactors* frames, const detail::FrameTarget* targets,
                         std::size_t count) const noexcept {
  const detail::PanelMatrix panels = matrix();
  detail::panel_product(panels, 0, panels.panels(), frames, targets, count);
}

FrameState::FrameState(const FrameModel& model)
    : model_(&model),
      motion_(BodyMotion::at_rest(model.landmark_count())),
      candidate_(motion_),
      q_(detail::make_weights(static_cast<std::size_t>(motion_.weights.size()))),
      weights_(detail::make_weights(model.weight_count())) {
  repeat_rigid();
}

bool FrameState::set_landmarks(const Eigen::Ref<const Points>& displacements) noexcept {
  if (displacements.rows() != model_->landmark_count()) return false;
  // Written so that NaN fails. Checked before the fit, which would spread one bad number over all.
  if (!(displacements.array().abs() <= model_->largest_weight_).all()) return false;
  split_motion(model_->landmark_rest_, displacements, model_->options_.mode, candidate_);
  return accept_candidate();
}

bool FrameState::set_motion(const BodyMotion& motion) noexcept {
  if (motion.weights.size() != candidate_.weights.size() ||
      !(motion.rigid.rotation.array().abs() <= detail::kLargestOfRotation).all()) {
    return false;  // not the shape, or not a rotation
  }
  candidate_ = motion;
  return accept_candidate();
}

bool FrameState::accept_candidate() noexcept {
  if (!(candidate_.weights.array().abs() <= model_->largest_weight_).all() ||
      !(candidate_.rigid.translation.array().abs() <= detail::kLargestNumber).all()) {
    return false;
  }
  std::swap(motion_, candidate_);
  for (Index k = 0; k < motion_.weights.size(); ++k) q_[std::size_t(k)] = static_cast<float>(motion_.weights[k]);
  factors_.weight_limit = model_->packed_weights(q_.data(), weights_.data());
  repeat_rigid();
  return true;
}

void FrameState::repeat_rigid() noexcept {
  RigidMotion rigid = motion_.rigid;
  if (model_->options_.directions) rigid.translation.setZero();
  detail::repeat_rigid(rigid, model_->centre_, factors_);
}

detail::FrameFactors FrameState::factors() const noexcept {
  detail::FrameFactors factors = factors_;
  factors.weights = weights_.data();  // not kept: it would not survive a copy of the state
  return factors;
}

bool FrameState::evaluate(std::span<float> positions) const noexcept {
  return positions.size() == 3 * model_->packed_.vertices && evaluate(VertexTarget{positions});
}

bool FrameState::evaluate(const VertexTarget& positions) const noexcept {
  if (!positions.holds(model_->packed_.vertices)) return false;
  const detail::FrameFactors frame = factors();
  const detail::FrameTarget target = model_->target(positions.vertex(0), positions.stride);
  model_->product(&frame, &target, 1);
  return true;
}

bool FrameState::evaluate(const VertexTarget& positions, FrameThreads& threads) const noexcept {
  const detail::PanelMatrix matrix = model_->matrix();
  if (!positions.holds(matrix.vertices)) return false;
  threads.run(matrix, model_->packed_.data.size(), factors(), model_->target(positions.vertex(0), positions.stride));
  return true;
}

bool evaluate_batch(std::span<const FrameState> frames, std::span<float> positions) noexcept {
  if (frames.empty()) return positions.empty();
  const FrameModel& model = frames.front().model();
  const std::size_t frame_floats = 3 * model.packed_.vertices;
  if (positions.size() != frames.size() * frame_floats) return false;
  for (const FrameState& frame : frames) {
    if (&frame.model() != &model) return false;
  }
  // Few enough that the factors stay on the stack, and a panel in the first-level cache, while all of them use it.
  constexpr std::size_t kGroup = 16;
  std::array<detail::FrameFactors, kGroup> factors;
  std::array<detail::FrameTarget, kGroup> targets;
  for (std::size_t begin = 0; begin < frames.size(); begin += kGroup) {
    const std::size_t count = std::min(kGroup, frames.size() - begin);
    for (std::size_t f = 0; f < count; ++f) {
      factors[f] = frames[begin + f].factors();
      targets[f] = model.target(positions.data() + (begin + f) * frame_floats, 3);
    }
    model.product(factors.data(), targets.data(), count);
  }
  return true;
}

}  // namespace skinbem
