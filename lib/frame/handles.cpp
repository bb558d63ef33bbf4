// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/frame/handles.hpp>

#include <algorithm>
#include <string>

#include <skinbem/base/error.hpp>
#include <skinbem/base/rigid_fit.hpp>
#include <skinbem/frame/frame_factors.hpp>

namespace skinbem {
namespace {

/// Columns of a panel before those of the handles: the rigid modes.
constexpr Index kRigid = 6;
constexpr auto kNumbers = static_cast<Index>(detail::kColumnNumbers);

/// Ratio of the second to the first extent of the handles: below, the rotation's own error would be its inverse.
constexpr double kOnALine = 1e-6;
/// Displacements beyond this are refused: far outside of any body, and far within the range of float.
constexpr double kLargestDisplacement = 1e12;

}  // namespace

Handles::Handles(const HandleModel& model, std::span<const std::int32_t> vertices, Index most)
    : model_(&model),
      most_((check(model, vertices, most), most)),
      count_(static_cast<Index>(vertices.size())),
      vertices_(static_cast<std::size_t>(most) + 1),
      displacements_(Eigen::VectorXd::Zero(3 * most + 3)),
      solution_(Eigen::VectorXd::Zero(kRigid + 3 * most + 3)),
      capacitance_(system_of(model, vertices), most + 1),
      columns_(solution_.size(), 3),
      rows_(solution_.size(), 3),
      positions_(most + 1, 3),
      centre_(model.rest_.colwise().mean()),
      panels_(static_cast<std::size_t>(model.vertex_count()), static_cast<std::size_t>(kRigid + 3 * most + 3)),
      weights_(static_cast<std::size_t>(solution_.size()), 0.0F) {
  std::copy(vertices.begin(), vertices.end(), vertices_.begin());
  const Points centred = model.rest_.rowwise() - centre_.transpose();
  panels_.set_rest(std::span(centred.data(), static_cast<std::size_t>(centred.size())));
  for (Index j = 0; j < kRigid; ++j) {
    panels_.set_column(static_cast<std::size_t>(j), std::span(model.B_.col(j).data(), std::size_t(model.B_.rows())));
  }
  for (Index k = 0; k < count_; ++k) set_panel_columns(k);
  detail::repeat_rigid({}, centre_, factors_);
  update_columns();
}

void Handles::check(const HandleModel& model, std::span<const std::int32_t> vertices, Index most) {
  if (Index(vertices.size()) > most) {
    throw Error(ErrorCode::usage, std::to_string(vertices.size()) + " handles, but room for " + std::to_string(most));
  }
  Points places(Index(vertices.size()), 3);
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    if (vertices[k] < 0 || vertices[k] >= model.vertex_count()) {
      throw Error(ErrorCode::usage, "handle on vertex " + std::to_string(vertices[k]) + " of a skin of " +
                                        std::to_string(model.vertex_count()) + " vertices (counted from 0)");
    }
    if (std::count(vertices.begin(), vertices.end(), vertices[k]) > 1) {
      throw Error(ErrorCode::usage, "two handles on vertex " + std::to_string(vertices[k]) + "; leave one out");
    }
    places.row(Index(k)) = model.handle_rest().row(vertices[k]);
  }
  if (places.rows() < 3 || collinear_measure(places) < kOnALine) {
    throw Error(ErrorCode::bad_input,
                "at least three handles that are not on a line are needed, or the body is free to turn; add some");
  }
}

Eigen::MatrixXd Handles::system_of(const HandleModel& model, std::span<const std::int32_t> vertices) {
  const Index n = 3 * Index(vertices.size());
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(kRigid + n, kRigid + n);
  for (Index k = 0; 3 * k < n; ++k) {
    const Index row = kRigid + 3 * k;
    const Index v = vertices[static_cast<std::size_t>(k)];
    system.block<6, 3>(0, row) = model.L_.middleCols<3>(3 * v);
    system.block<3, 6>(row, 0) = model.measure_rigid(v);
    for (Index l = 0; 3 * l < n; ++l) {
      system.block<3, 3>(row, kRigid + 3 * l) = model.measure(v, vertices[static_cast<std::size_t>(l)]);
    }
  }
  return system;
}

bool Handles::grab(std::int32_t vertex) noexcept { return count_ < most_ && append(vertex); }

bool Handles::pull(Index k, const Vec3& displacement) noexcept {
  if (k < 0 || k >= count_ || !(displacement.array().abs() <= kLargestDisplacement).all()) return false;
  displacements_.segment<3>(3 * k) = displacement;
  solve();
  return true;
}

bool Handles::pull(const Eigen::Ref<const Points>& displacements) noexcept {
  if (displacements.rows() != count_ || !(displacements.array().abs() <= kLargestDisplacement).all()) return false;
  for (Index k = 0; k < count_; ++k) displacements_.segment<3>(3 * k) = displacements.row(k).transpose();
  solve();
  return true;
}

bool Handles::release(Index k) noexcept {
  if (k < 0 || k >= count_ || !determined_without(k) || !capacitance_.remove(k)) return false;
  const auto last = vertices_.begin() + count_;
  std::copy(vertices_.begin() + k + 1, last, vertices_.begin() + k);
  std::copy(displacements_.data() + 3 * k + 3, displacements_.data() + 3 * count_, displacements_.data() + 3 * k);
  for (std::size_t p = 0; p < panels_.panels(); ++p) {
    float* gap = handle_columns(p, k);
    std::copy(gap + 3 * kNumbers, handle_columns(p, count_), gap);
  }
  --count_;
  update_columns();
  solve();
  return true;
}

bool Handles::move(Index k, std::int32_t vertex) noexcept {
  if (k < 0 || k >= count_ || !append(vertex)) return false;
  const Index last = count_ - 1;
  if (!determined_without(k)) {
    capacitance_.remove(last);
    --count_;
    update_columns();
    solve();
    return false;
  }
  capacitance_.exchange(k, last);
  std::swap(vertices_[static_cast<std::size_t>(k)], vertices_[static_cast<std::size_t>(last)]);
  displacements_.segment<3>(3 * k).swap(displacements_.segment<3>(3 * last));
  set_panel_columns(k);
  return release(last);
}

bool Handles::append(std::int32_t vertex) noexcept {
  if (vertex < 0 || vertex >= model_->vertex_count() || has_handle(vertex)) return false;
  columns_.topRows<kRigid>() = model_->L_.middleCols<3>(3 * Index(vertex));
  rows_.topRows<kRigid>() = model_->measure_rigid(vertex).transpose();
  for (Index l = 0; l < count_; ++l) {
    columns_.middleRows<3>(kRigid + 3 * l) = model_->measure(this->vertex(l), vertex);
    rows_.middleRows<3>(kRigid + 3 * l) = model_->measure(vertex, this->vertex(l)).transpose();
  }
  const Index n = capacitance_.size();
  if (!capacitance_.append(columns_.topRows(n), rows_.topRows(n), model_->measure(vertex, vertex))) return false;
  displacements_.segment<3>(3 * count_) = rows_.topRows(n).transpose().lazyProduct(solution_.head(n));
  vertices_[static_cast<std::size_t>(count_)] = vertex;
  set_panel_columns(count_++);
  update_columns();
  solve();
  return true;
}

bool Handles::has_handle(std::int32_t vertex) const noexcept {
  const auto end = vertices_.begin() + count_;
  return std::find(vertices_.begin(), end, vertex) != end;
}

bool Handles::determined_without(Index k) noexcept {
  Index left = 0;
  for (Index l = 0; l < count_; ++l) {
    if (l != k) positions_.row(left++) = model_->handle_rest().row(vertex(l));
  }
  return left >= 3 && collinear_measure(positions_.topRows(left)) >= kOnALine;
}

void Handles::set_panel_columns(Index k) noexcept {
  for (std::size_t p = 0; p < panels_.panels(); ++p) {
    const float* from = model_->columns(vertex(k), p);
    std::copy(from, from + 3 * kNumbers, handle_columns(p, k));
  }
}

float* Handles::handle_columns(std::size_t panel, Index k) noexcept {
  return panels_.column(panel, static_cast<std::size_t>(kRigid + 3 * k));
}

void Handles::update_columns() noexcept { panels_.set_columns(static_cast<std::size_t>(kRigid + 3 * count_)); }

void Handles::solve() noexcept {
  const Index n = capacitance_.size();
  capacitance_.solve(displacements_.head(3 * count_), solution_.head(n));
  // Nothing that was accepted comes here; if it did, the last pose would stay, and stay finite.
  if (!(solution_.head(n).cwiseAbs().sum() * std::max(1.0, model_->largest_) <= detail::kLargestNumber)) return;
  for (Index i = 0; i < n; ++i) weights_[static_cast<std::size_t>(i)] = static_cast<float>(solution_(i));
}

bool Handles::set_body_motion(const RigidMotion& motion) noexcept {
  if (!(motion.rotation.array().abs() <= detail::kLargestOfRotation).all() ||
      !(motion.translation.array().abs() <= detail::kLargestNumber).all()) {
    return false;
  }
  detail::repeat_rigid(motion, centre_, factors_);
  return true;
}

detail::FrameFactors Handles::factors() const noexcept {
  detail::FrameFactors factors = factors_;
  factors.weights = weights_.data();  // not kept: it would not survive a copy
  return factors;
}

bool Handles::evaluate(const VertexTarget& positions) const noexcept {
  const detail::PanelMatrix panels = panels_.matrix();
  if (!positions.holds(panels.vertices)) return false;
  const detail::FrameFactors frame = factors();
  const detail::FrameTarget target{positions.vertex(0), positions.stride};
  detail::panel_product(panels, 0, panels.panels(), &frame, &target, 1);
  return true;
}

bool Handles::evaluate(const VertexTarget& positions, FrameThreads& threads) const noexcept {
  const detail::PanelMatrix panels = panels_.matrix();
  if (!positions.holds(panels.vertices)) return false;
  threads.run(panels, panels_.bytes(), factors(), {positions.vertex(0), positions.stride});
  return true;
}

}  // namespace skinbem
