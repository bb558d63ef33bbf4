// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A matrix in 16 bits, for preconditioners: what they lose costs no accuracy, at most an iteration.
#pragma once

#include <skinbem/base/aligned_buffer.hpp>
#include <skinbem/base/types.hpp>
#include <skinbem/hmatrix/tile_product.hpp>

namespace skinbem {

/// #tiles of kTile rows each, of the same width.
class PackedTiles {
 public:
  PackedTiles() = default;
  /// Not initialised.
  PackedTiles(std::size_t tiles, std::size_t width)
      : tiles_(tiles), width_(width), numbers_(tiles * width * kTile), scales_(tiles * width) {}

  std::size_t size() const { return tiles_; }
  std::size_t bytes() const { return numbers_.size() * sizeof(std::int16_t) + scales_.size() * sizeof(float); }
  /// From kTile values, which become what rounding loses of them (pack_column). Different columns at the same time are
  /// fine.
  void set_column(std::size_t tile, std::size_t column, float* values) {
    const std::size_t k = tile * width_ + column;
    scales_.data()[k] = pack_column(values, kTile, numbers_.data() + k * kTile);
  }
  /// Rows kTile #tile and on, times `rhs` (width by #columns, row-major), to `out`.
  void multiply(std::size_t tile, const float* rhs, std::size_t columns, float* out) const {
    const RowRange<float> range{rhs, width_};
    const std::size_t first = tile * width_;
    multiply_tile(PackedTile{numbers_.data() + first * kTile, scales_.data() + first}, kTile, std::span(&range, 1),
                  columns, out);
  }

 private:
  std::size_t tiles_ = 0, width_ = 0;
  detail::Uninitialised<std::int16_t> numbers_;
  detail::Uninitialised<float> scales_;
};

}  // namespace skinbem
