// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/hmatrix/tile_product.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

// Vectors of a length unknown at compile time cannot be array elements; such machines use their fixed-length set.
#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_RVV | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#endif
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "skinbem/hmatrix/tile_product.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h comes first
#include <hwy/cache_control.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace skinbem {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Columns of the result that are summed at once, beside three vectors of rows: as registers allow.
constexpr std::size_t kColumns = HWY_TARGET <= HWY_AVX3 ? 6 : 4;

/// The next slice, asked for from memory a little with every column of the one that is multiplied: otherwise the
/// processor would wait for it.
struct Ahead {
  const char* next;
  std::size_t step;  ///< bytes
};

/// sums (column by column, kTile apart) += strip of kVectors vectors of the tile times kRhs columns. A slice is summed
/// by itself before it is added: in single precision the error of a long row is that of a short one.
/// Loops over sums are expanded from index sequences: compilers keep an array in registers only where every index is a
/// constant from the outset.
template <std::size_t kRhs, class T, std::size_t... kSum>
HWY_INLINE void multiply_strip(const T* HWY_RESTRICT strip, std::size_t height, std::size_t depth,
                               const T* HWY_RESTRICT rhs, std::size_t columns, T* HWY_RESTRICT sums, Ahead ahead,
                               std::index_sequence<kSum...>) {
  using D = hn::CappedTag<T, kTileStep>;
  using V = hn::Vec<D>;
  constexpr std::size_t lanes = hn::MaxLanes(D());
  constexpr std::size_t vectors = sizeof...(kSum) / kRhs;
  const D d;
  V sum[] = {((void)kSum, hn::Zero(d))...};
  for (std::size_t k = 0; k < depth; ++k, strip += height, rhs += columns, ahead.next += ahead.step) {
    hwy::Prefetch(ahead.next);
    ((sum[kSum] = hn::MulAdd(hn::Load(d, strip + kSum % vectors * lanes), hn::Set(d, rhs[kSum / vectors]), sum[kSum])),
     ...);
  }
  const auto add = [&](V value, T* to) HWY_ATTR { hn::Store(hn::Add(hn::Load(d, to), value), d, to); };
  (add(sum[kSum], sums + kSum / vectors * kTile + kSum % vectors * lanes), ...);
}

template <std::size_t kVectors, class T>
HWY_INLINE void multiply_strip_columns(const T* strip, std::size_t height, std::size_t depth, const T* rhs,
                                       std::size_t columns, T* sums, Ahead ahead) {
  const auto some = [&](auto count, std::size_t first) HWY_ATTR {
    multiply_strip<count>(strip, height, depth, rhs + first, columns, sums + first * kTile, ahead,
                          std::make_index_sequence<kVectors * count>());
    ahead.next += depth * ahead.step;
  };
  std::size_t first = 0;
  for (; first + kColumns <= columns; first += kColumns) some(std::integral_constant<std::size_t, kColumns>(), first);
  for (; first + 3 <= columns; first += 3) some(std::integral_constant<std::size_t, 3>(), first);
  for (; first < columns; ++first) some(std::integral_constant<std::size_t, 1>(), first);
}

/// kDepth or fewer columns of the tile times all right-hand sides.
template <class T>
HWY_INLINE void multiply_slice(const T* slice, std::size_t height, std::size_t depth, const T* rhs, std::size_t columns,
                               T* sums, Ahead ahead) {
  constexpr std::size_t lanes = hn::MaxLanes(hn::CappedTag<T, kTileStep>());
  std::size_t row = 0;
  for (; row + 3 * lanes <= height; row += 3 * lanes)
    multiply_strip_columns<3>(slice + row, height, depth, rhs, columns, sums + row, ahead);
  for (; row + 2 * lanes <= height; row += 2 * lanes)
    multiply_strip_columns<2>(slice + row, height, depth, rhs, columns, sums + row, ahead);
  for (; row + lanes <= height; row += lanes)
    multiply_strip_columns<1>(slice + row, height, depth, rhs, columns, sums + row, ahead);
}

/// A tile as it lies in memory, slice by slice.
template <class T>
class FullTile {
 public:
  explicit FullTile(const T* numbers) : next_(numbers) {}
  HWY_INLINE const T* next_slice(std::size_t height, std::size_t depth) {
    return std::exchange(next_, next_ + height * depth);
  }
  const char* next() const { return reinterpret_cast<const char*>(next_); }
  static std::size_t column_bytes(std::size_t height) { return height * sizeof(T); }

 private:
  const T* next_;
};

/// Slices of a packed tile, unpacked into the first-level cache.
class UnpackedTile {
 public:
  explicit UnpackedTile(PackedTile tile) : next_(tile) {}
  HWY_INLINE const float* next_slice(std::size_t height, std::size_t depth) {
    const hn::CappedTag<float, kTileStep> d;
    const hn::Rebind<std::int16_t, decltype(d)> d16;
    const hn::Rebind<std::int32_t, decltype(d)> d32;
    for (std::size_t k = 0; k < depth; ++k) {
      const auto scale = hn::Set(d, next_.scales[k]);
      for (std::size_t r = 0; r < height; r += hn::Lanes(d)) {
        const auto number = hn::PromoteTo(d32, hn::LoadU(d16, next_.numbers + k * height + r));
        const auto root = hn::Mul(hn::ConvertTo(d, number), scale);
        hn::Store(hn::Mul(root, hn::Abs(root)), d, slice_ + k * height + r);
      }
    }
    next_.numbers += height * depth;
    next_.scales += depth;
    return slice_;
  }
  const char* next() const { return reinterpret_cast<const char*>(next_.numbers); }
  static std::size_t column_bytes(std::size_t height) { return height * sizeof(std::int16_t); }

 private:
  PackedTile next_;
  HWY_ALIGN float slice_[kTile * kDepth];
};

template <class T, class Tile>
HWY_INLINE void multiply(Tile tile, std::size_t height, std::span<const RowRange<T>> ranges, std::size_t columns,
                         T* out) {
  HWY_ALIGN T sums[kTile * kMostColumns];
  std::fill_n(sums, kTile * columns, T(0));
  for (const RowRange<T>& range : ranges) {
    for (std::size_t done = 0; done < range.length; done += kDepth) {
      const std::size_t depth = std::min(kDepth, range.length - done);
      const T* slice = tile.next_slice(height, depth);
      const Ahead ahead{tile.next(), tile.column_bytes(height) / std::max<std::size_t>(1, columns / kColumns)};
      multiply_slice(slice, height, depth, range.first + done * columns, columns, sums, ahead);
    }
  }
  store_sums(sums, height, columns, out);
}

/// Nothing follows that could be asked for.
template <class T>
HWY_INLINE void add_single_slice(const T* slice, std::size_t height, std::size_t depth, const T* rhs,
                                 std::size_t columns, T* sums) {
  multiply_slice(slice, height, depth, rhs, columns, sums, {reinterpret_cast<const char*>(slice), 0});
}

void add_slice_f32(const float* slice, std::size_t height, std::size_t depth, const float* rhs, std::size_t columns,
                   float* sums) {
  add_single_slice(slice, height, depth, rhs, columns, sums);
}

void add_slice_f64(const double* slice, std::size_t height, std::size_t depth, const double* rhs, std::size_t columns,
                   double* sums) {
  add_single_slice(slice, height, depth, rhs, columns, sums);
}

void multiply_f32(const float* tile, std::size_t height, std::span<const RowRange<float>> ranges, std::size_t columns,
                  float* out) {
  multiply(FullTile(tile), height, ranges, columns, out);
}

void multiply_f64(const double* tile, std::size_t height, std::span<const RowRange<double>> ranges, std::size_t columns,
                  double* out) {
  multiply(FullTile(tile), height, ranges, columns, out);
}

void multiply_packed(PackedTile tile, std::size_t height, std::span<const RowRange<float>> ranges, std::size_t columns,
                     float* out) {
  multiply(UnpackedTile(tile), height, ranges, columns, out);
}

float pack(float* values, std::size_t height, std::int16_t* numbers) {
  const hn::CappedTag<float, kTileStep> d;
  const hn::Rebind<std::int16_t, decltype(d)> d16;
  constexpr float most = 32767;
  auto largest = hn::Zero(d);
  for (std::size_t r = 0; r < height; r += hn::Lanes(d)) {
    largest = hn::Max(largest, hn::Abs(hn::LoadU(d, values + r)));
  }
  const float scale =
      std::max(std::sqrt(hn::GetLane(hn::MaxOfLanes(d, largest))) / most, std::numeric_limits<float>::min());
  const auto inverse = hn::Set(d, 1 / scale);
  for (std::size_t r = 0; r < height; r += hn::Lanes(d)) {
    const auto value = hn::LoadU(d, values + r);
    const auto number = hn::NearestInt(hn::CopySign(hn::Mul(hn::Sqrt(hn::Abs(value)), inverse), value));
    const auto root = hn::Mul(hn::ConvertTo(d, number), hn::Set(d, scale));
    hn::StoreU(hn::DemoteTo(d16, number), d16, numbers + r);
    hn::StoreU(hn::NegMulAdd(root, hn::Abs(root), value), d, values + r);
  }
  return scale;
}

}  // namespace HWY_NAMESPACE
}  // namespace skinbem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skinbem {

HWY_EXPORT(multiply_f32);
HWY_EXPORT(multiply_f64);
HWY_EXPORT(multiply_packed);
HWY_EXPORT(add_slice_f32);
HWY_EXPORT(add_slice_f64);
HWY_EXPORT(pack);

void multiply_tile(const float* tile, std::size_t height, std::span<const RowRange<float>> ranges, std::size_t columns,
                   float* out) {
  HWY_DYNAMIC_DISPATCH(multiply_f32)(tile, height, ranges, columns, out);
}

void multiply_tile(const double* tile, std::size_t height, std::span<const RowRange<double>> ranges,
                   std::size_t columns, double* out) {
  HWY_DYNAMIC_DISPATCH(multiply_f64)(tile, height, ranges, columns, out);
}

void multiply_tile(PackedTile tile, std::size_t height, std::span<const RowRange<float>> ranges, std::size_t columns,
                   float* out) {
  HWY_DYNAMIC_DISPATCH(multiply_packed)(tile, height, ranges, columns, out);
}

void add_slice(const float* slice, std::size_t height, std::size_t depth, const float* rhs, std::size_t columns,
               float* sums) {
  HWY_DYNAMIC_DISPATCH(add_slice_f32)(slice, height, depth, rhs, columns, sums);
}

void add_slice(const double* slice, std::size_t height, std::size_t depth, const double* rhs, std::size_t columns,
               double* sums) {
  HWY_DYNAMIC_DISPATCH(add_slice_f64)(slice, height, depth, rhs, columns, sums);
}

float pack_column(float* values, std::size_t height, std::int16_t* numbers) {
  return HWY_DYNAMIC_DISPATCH(pack)(values, height, numbers);
}

}  // namespace skinbem
#endif
