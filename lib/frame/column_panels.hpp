// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Panels in single precision whose columns come and go within a frame. Internal to the floor.
#pragma once

#include <skinbem/base/aligned_buffer.hpp>
#include <skinbem/frame/panel_product.hpp>

#include <vector>

namespace skinbem::detail {

/// [rest, column 0, column 1, ...] by panels, with room for more columns. The memory is allocated once.
class ColumnPanels {
 public:
  ColumnPanels(std::size_t vertices, std::size_t most_columns)
      : vertices_(vertices),
        pitch_((1 + most_columns) * kColumnNumbers),
        places_((vertices + kPanelWidth - 1) / kPanelWidth),
        numbers_(places_.size() * pitch_, 0.0F) {
    set_columns(0);
  }

  std::size_t panels() const noexcept { return places_.size(); }
  /// The first `columns` are summed.
  void set_columns(std::size_t columns) noexcept {
    for (std::size_t p = 0; p < places_.size(); ++p) places_[p] = {p * pitch_ * sizeof(float), columns};
  }
  /// The rest positions of a panel, or one of its columns: x of 32 vertices, then y, then z; further columns follow.
  float* rest(std::size_t panel) noexcept { return numbers_.data() + panel * pitch_; }
  float* column(std::size_t panel, std::size_t c) noexcept { return rest(panel) + (1 + c) * kColumnNumbers; }

  /// Rest positions or a column from `numbers`, indexed node-major: x, y, z of vertex 0, then of vertex 1.
  template <class Numbers>
  void set_rest(const Numbers& numbers) noexcept {
    spread(numbers, 0);
  }
  template <class Numbers>
  void set_column(std::size_t c, const Numbers& numbers) noexcept {
    spread(numbers, (1 + c) * kColumnNumbers);
  }

  PanelMatrix matrix() const noexcept {
    return {reinterpret_cast<const std::byte*>(numbers_.data()), places_.data(), vertices_, false};
  }
  /// Bytes that a frame reads.
  std::size_t bytes() const noexcept {
    return places_.empty() ? 0 : places_.size() * (1 + places_[0].entries) * kColumnNumbers * sizeof(float);
  }

 private:
  template <class Numbers>
  void spread(const Numbers& numbers, std::size_t shift) noexcept {
    for (std::size_t v = 0; v < vertices_; ++v) {
      float* to = numbers_.data() + v / kPanelWidth * pitch_ + shift + v % kPanelWidth;
      for (std::size_t c = 0; c < 3; ++c) to[c * kPanelWidth] = static_cast<float>(numbers[3 * v + c]);
    }
  }

  std::size_t vertices_;
  std::size_t pitch_;  // floats
  std::vector<PanelPlace> places_;
  AlignedVector<float> numbers_;
};

}  // namespace skinbem::detail
