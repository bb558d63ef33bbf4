// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The one product that everything compressed is made of: a wide, packed matrix times a few columns.
#pragma once

#include <cstddef>
#include <cstdint>
#include <span>

namespace skinbem {

/// Rows of a packed matrix are stored in tiles of this many, a multiple of every vector length; the last tile of a
/// matrix may have fewer, a multiple of kTileStep. Within a tile numbers are ordered column by column.
inline constexpr std::size_t kTile = 48;
inline constexpr std::size_t kTileStep = 16;

/// Right-hand sides at once.
inline constexpr std::size_t kMostColumns = 48;

/// #length consecutive rows of a row-major matrix of right-hand sides.
template <class T>
struct RowRange {
  const T* first;
  std::size_t length;
};

/// A tile whose numbers take 16 bits: number (r, k) is q |q|, q = numbers[k height + r] * scales[k]. The finer the
/// smaller it is: in a near block's column the entries of neighbours are large, the others are not.
struct PackedTile {
  const std::int16_t* numbers;
  const float* scales;
};

/// One tile times stacked right-hand sides: `tile` is height by (sum of the ranges' lengths), the result (height by
/// #columns, row-major, adjacent) is written to `out`; at most kMostColumns columns. Sums run in the order of storage,
/// so the result does not depend on who calls.
void multiply_tile(const float* tile, std::size_t height, std::span<const RowRange<float>> ranges, std::size_t columns,
                   float* out);
void multiply_tile(const double* tile, std::size_t height, std::span<const RowRange<double>> ranges,
                   std::size_t columns, double* out);
void multiply_tile(PackedTile tile, std::size_t height, std::span<const RowRange<float>> ranges, std::size_t columns,
                   float* out);

/// At most so many columns of a tile are multiplied with all right-hand sides before the next: they and their sums stay
/// in the first-level cache.
inline constexpr std::size_t kDepth = 96;

/// Adds `slice`, height by depth <= kDepth, column by column and aligned to 64 bytes, times `rhs`, depth by #columns,
/// row-major, to sums[c kTile + r].
void add_slice(const float* slice, std::size_t height, std::size_t depth, const float* rhs, std::size_t columns,
               float* sums);
void add_slice(const double* slice, std::size_t height, std::size_t depth, const double* rhs, std::size_t columns,
               double* sums);

/// From such sums to rows.
template <class T>
void store_sums(const T* sums, std::size_t height, std::size_t columns, T* out) {
  for (std::size_t r = 0; r < height; ++r) {
    for (std::size_t c = 0; c < columns; ++c) out[r * columns + c] = sums[c * kTile + r];
  }
}

/// One column of a PackedTile from `height` values, and its scale. The values become what is lost: of a value v at
/// most (|v|^1/2 + scale / 4) scale, where scale is 1/32767 of the largest |v|^1/2.
float pack_column(float* values, std::size_t height, std::int16_t* numbers);

}  // namespace skinbem
