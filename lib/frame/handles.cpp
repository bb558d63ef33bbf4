// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/frame/handles.hpp>

#include <algorithm>
#include <cmath>
#include <string>

#include <skinbem/base/error.hpp>
#include <skinbem/base/rigid_fit.hpp>
#include <skinbem/frame/frame_factors.hpp>

namespace skinbem {
namespace {

/// Columns of a panel before those of the handles: rest positions and the six rigid modes.
constexpr Index kRigid = 6;
constexpr Index kBefore = 1 + kRigid;
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
      panels_(model.panels() * static_cast<std::size_t>((kBefore + 3 * most + 3) * kNumbers), 0.0F),
      places_(model.panels()),
      weights_(static_cast<std::size_t>(solution_.size()), 0.0F) {
  std::copy(vertices.begin(), vertices.end(), vertices_.begin());
  const Points centred = model.rest_.rowwise() - centre_.transpose();
  const auto copy_column = [&](Index column, const auto& numbers) {
    for (Index i = 0; i < 3 * model.vertex_count(); ++i) {
      const Index vertex = i / 3, panel = vertex / Index{detail::kPanelWidth};
      float* to = panel_column(static_cast<std::size_t>(panel), column);
      to[i % 3 * Index{detail::kPanelWidth} + vertex % Index{detail::kPanelWidth}] = static_cast<float>(numbers(i));
    }
  };
  copy_column(0, Eigen::Map<const Eigen::VectorXd>(centred.data(), centred.size()));
  for (Index j = 0; j < kRigid; ++j) copy_column(1 + j, model.B_.col(j));
  for (Index k = 0; k < count_; ++k) set_panel_columns(k);
  detail::repeat_rigid({}, centre_, factors_);
  update_places();
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
  for (std::size_t p = 0; p < places_.size(); ++p) {
    float* gap = panel_column(p, kBefore + 3 * k);
    std::copy(gap + 3 * kNumbers, panel_column(p, kBefore + 3 * count_), gap);
  }
  --count_;
  update_places();
  solve();
  return true;
}

bool Handles::move(Index k, std::int32_t vertex) noexcept {
  if (k < 0 || k >= count_ || !append(vertex)) return false;
  const Index last = count_ - 1;
  if (!determined_without(k)) {
    capacitance_.remove(last);
    --count_;
    update_places();
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
  update_places();
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
  for (std::size_t p = 0; p < places_.size(); ++p) {
    const float* from = model_->columns(vertex(k), p);
    std::copy(from, from + 3 * kNumbers, panel_column(p, kBefore + 3 * k));
  }
}

float* Handles::panel_column(std::size_t panel, Index column) noexcept {
  const auto pitch = panels_.size() / places_.size();
  return panels_.data() + panel * pitch + static_cast<std::size_t>(column * kNumbers);
}

void Handles::update_places() noexcept {
  const auto entries = static_cast<std::size_t>(kRigid + 3 * count_);
  const std::size_t pitch = panels_.size() / places_.size() * sizeof(float);
  for (std::size_t p = 0; p < places_.size(); ++p) places_[p] = {p * pitch, entries};
}

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

detail::PanelMatrix Handles::matrix() const noexcept {
  return {reinterpret_cast<const std::byte*>(panels_.data()), places_.data(),
          static_cast<std::size_t>(model_->vertex_count()), false};
}

detail::FrameFactors Handles::factors() const noexcept {
  detail::FrameFactors factors = factors_;
  factors.weights = weights_.data();  // not kept: it would not survive a copy
  return factors;
}

bool Handles::evaluate(const VertexTarget& positions) const noexcept {
  const detail::PanelMatrix panels = matrix();
  if (!positions.holds(panels.vertices)) return false;
  const detail::FrameFactors frame = factors();
  const detail::FrameTarget target{positions.vertex(0), positions.stride};
  detail::panel_product(panels, 0, panels.panels(), &frame, &target, 1);
  return true;
}

bool Handles::evaluate(const VertexTarget& positions, FrameThreads& threads) const noexcept {
  const detail::PanelMatrix panels = matrix();
  if (!positions.holds(panels.vertices)) return false;
  const std::size_t bytes =
      panels.panels() * static_cast<std::size_t>((kBefore + 3 * count_) * kNumbers) * sizeof(float);
  threads.run(panels, bytes, factors(), {positions.vertex(0), positions.stride});
  return true;
}

}  // namespace skinbem
