// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/frame/handle_model.hpp>

#include <algorithm>
#include <string>

#include <skinbem/base/error.hpp>
#include <skinbem/frame/panel_product.hpp>
#include <skinbem/solve/rigid_modes.hpp>

namespace skinbem {
namespace {

/// Floats of three columns of a panel.
constexpr std::size_t kHandleNumbers = 3 * detail::kColumnNumbers;
/// Vertices solved for at once: enough for the factorisation to work on matrices.
constexpr Index kBlock = 128;

/// Place of component c of vertex i among the floats of one column, all panels.
std::size_t place_of(Index i, Index c) {
  const auto v = static_cast<std::size_t>(i);
  return v / detail::kPanelWidth * kHandleNumbers + static_cast<std::size_t>(c) * detail::kPanelWidth +
         v % detail::kPanelWidth;
}

}  // namespace

HandleModel::HandleModel(ResponseModel& body, double radius)
    : radius_(radius),
      rest_(body.mesh().vertices),
      handle_rest_(rest_.rows(), 3),
      B_(rigid_modes(rest_)),
      L_(6, 3 * rest_.rows()) {
  const Index n = rest_.rows();
  if (n > kMostVertices) {
    throw Error(ErrorCode::bad_input, "the skin has " + std::to_string(n) +
                                          " vertices; handles on all of them are for " + std::to_string(kMostVertices) +
                                          " at most: use a coarser skin");
  }
  greens_.assign(static_cast<std::size_t>(n) * panels() * kHandleNumbers, 0.0F);
  largest_ = B_.cwiseAbs().maxCoeff();
  std::vector<Landmark> block;
  for (Index v = 0; v < n; ++v) {
    block.push_back({.name = std::to_string(v), .vertex = static_cast<std::int32_t>(v), .radius = radius});
    if (Index(block.size()) < kBlock && v + 1 < n) continue;
    for (const GreensFunctions& greens : body.greens_functions(block)) keep(greens);
    block.clear();
  }
}

void HandleModel::keep(const GreensFunctions& greens) {
  const Index v = greens.landmark.vertex;
  handle_rest_.row(v) = greens.patch.measure(rest_).transpose();
  measurement_.insert(measurement_.end(), greens.patch.measurement.begin(), greens.patch.measurement.end());
  begin_.push_back(measurement_.size());
  L_.middleCols<3>(3 * v) = greens.L;
  largest_ = std::max(largest_, greens.X.cwiseAbs().maxCoeff());
  float* columns = greens_.data() + static_cast<std::size_t>(v) * panels() * kHandleNumbers;
  for (Index j = 0; j < 3; ++j, columns += detail::kColumnNumbers) {
    for (Index i = 0; i < rest_.rows(); ++i) {
      for (Index c = 0; c < 3; ++c) columns[place_of(i, c)] = static_cast<float>(greens.X(3 * i + c, j));
    }
  }
}

std::size_t HandleModel::panels() const noexcept {
  return (static_cast<std::size_t>(rest_.rows()) + detail::kPanelWidth - 1) / detail::kPanelWidth;
}

const float* HandleModel::columns(Index v, std::size_t p) const noexcept {
  return greens_.data() + (static_cast<std::size_t>(v) * panels() + p) * kHandleNumbers;
}

Mat3 HandleModel::measure(Index v, Index source) const noexcept {
  Mat3 block = Mat3::Zero();
  const float* column = columns(source, 0);
  for (std::size_t w = begin_[v]; w < begin_[v + 1]; ++w) {
    const VertexWeight& weight = measurement_[w];
    for (Index j = 0; j < 3; ++j) {
      for (Index c = 0; c < 3; ++c) {
        block(c, j) += weight.value * double{column[place_of(weight.vertex, c) + j * detail::kColumnNumbers]};
      }
    }
  }
  return block;
}

Eigen::Matrix<double, 3, 6> HandleModel::measure_rigid(Index v) const noexcept {
  Eigen::Matrix<double, 3, 6> block = Eigen::Matrix<double, 3, 6>::Zero();
  for (std::size_t w = begin_[v]; w < begin_[v + 1]; ++w) {
    block += measurement_[w].value * B_.middleRows<3>(3 * Index(measurement_[w].vertex));
  }
  return block;
}

}  // namespace skinbem
