// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/hmatrix/block_rows.hpp>

#include <algorithm>
#include <cmath>

namespace skinbem {
namespace {

constexpr Index tile_height = Index(kTile);

/// Rows of the tile that begins with row `first`.
Index height_of(const BlockRow& row, Index first) { return std::min(tile_height, row.out.length - first); }

/// Where the numbers of a tile's column begin, and its scale.
std::size_t column_offset(const BlockRow& row, Index first, Index k) {
  return row.offset + static_cast<std::size_t>(first * row.width + k * height_of(row, first));
}
std::size_t scale_index(const BlockRow& row, Index first, Index k) {
  return row.scale_offset + static_cast<std::size_t>(first / tile_height * row.width + k);
}

}  // namespace

template <class T>
std::size_t BlockRows<T>::add(BlockRow row) {
  row.packed = row.packed && std::is_same_v<T, float>;
  row.width = 0;
  for (const WorkRange& source : row.sources) row.width += source.length;
  rows_.push_back(std::move(row));
  return rows_.size() - 1;
}

template <class T>
void BlockRows<T>::allocate() {
  std::size_t total[2] = {0, 0}, scales = 0;
  for (BlockRow& row : rows_) {
    row.offset = total[row.packed];
    row.scale_offset = scales;
    total[row.packed] += row.numbers();
    scales += row.scales();
  }
  numbers_ = detail::Uninitialised<T>(total[false]);
  packed_ = detail::Uninitialised<std::int16_t>(total[true]);
  scales_ = detail::Uninitialised<float>(scales);
}

template <class T>
void BlockRows<T>::set_column(std::size_t row, Index first, Index k, T* values) {
  const BlockRow& b = rows_[row];
  const std::size_t height = static_cast<std::size_t>(height_of(b, first)), offset = column_offset(b, first, k);
  if constexpr (std::is_same_v<T, float>) {
    if (b.packed) {
      scales_.data()[scale_index(b, first, k)] = pack_column(values, height, packed_.data() + offset);
      return;
    }
  }
  std::copy_n(values, height, numbers_.data() + offset);
  std::fill_n(values, height, T(0));
}

template <class T>
void BlockRows<T>::get_column(std::size_t row, Index first, Index k, T* values) const {
  const BlockRow& b = rows_[row];
  const std::size_t height = static_cast<std::size_t>(height_of(b, first)), offset = column_offset(b, first, k);
  if (!b.packed) {
    std::copy_n(numbers_.data() + offset, height, values);
    return;
  }
  const T scale = T(scales_.data()[scale_index(b, first, k)]);
  for (std::size_t r = 0; r < height; ++r) {
    const T root = packed_.data()[offset + r] * scale;
    values[r] = root * std::abs(root);
  }
}

/// Consecutive columns of the tile that begins with row `first`, from `column` on.
template <class T>
void BlockRows<T>::multiply_tile_of(const BlockRow& row, Index first, Index column, std::span<const RowRange<T>> ranges,
                                    Index columns, T* out) const {
  const std::size_t height = static_cast<std::size_t>(height_of(row, first)),
                    offset = column_offset(row, first, column);
  if constexpr (std::is_same_v<T, float>) {
    if (row.packed) {
      const PackedTile tile{packed_.data() + offset, scales_.data() + scale_index(row, first, column)};
      multiply_tile(tile, height, ranges, static_cast<std::size_t>(columns), out);
      return;
    }
  }
  multiply_tile(numbers_.data() + offset, height, ranges, static_cast<std::size_t>(columns), out);
}

template <class T>
template <class Wanted>
bool BlockRows<T>::multiply_row(const BlockRow& row, Block& work, bool adds, const Wanted& wanted) const {
  struct Run {  // of sources that are wanted, one after the other
    Index column;
    std::size_t first, count;
  };
  thread_local std::vector<RowRange<T>> ranges;
  thread_local std::vector<Run> runs;
  ranges.clear();
  runs.clear();
  Index column = 0, end = -1;
  for (const WorkRange& source : row.sources) {
    if (wanted(source)) {
      if (column != end) runs.push_back({column, ranges.size(), 0});
      ranges.push_back({work.data() + source.first * work.cols(), static_cast<std::size_t>(source.length)});
      ++runs.back().count;
      end = column + source.length;
    }
    column += source.length;
  }
  Block part(tile_height, adds || runs.size() > 1 ? work.cols() : 0);
  for (Index first = 0; first < row.out.length; first += tile_height) {
    const Index height = height_of(row, first);
    for (std::size_t k = 0; k < runs.size(); ++k) {
      const auto sources = std::span<const RowRange<T>>(ranges).subspan(runs[k].first, runs[k].count);
      const bool added = adds || k > 0;
      T* out = work.row(row.out.first + first).data();
      multiply_tile_of(row, first, runs[k].column, sources, work.cols(), added ? part.data() : out);
      if (added) work.middleRows(row.out.first + first, height) += part.topRows(height);
    }
  }
  return !runs.empty();
}

template <class T>
void BlockRows<T>::run(Block& work) const {
#pragma omp parallel
  for (std::size_t s = 0; s < stages_.size(); ++s) {
    const std::size_t last = s + 1 < stages_.size() ? stages_[s + 1] : rows_.size();
#pragma omp for schedule(dynamic, 1)
    for (std::size_t k = stages_[s]; k < last; ++k) {
      multiply_row(rows_[k], work, rows_[k].adds, [](const WorkRange&) { return true; });
    }
  }
}

template <class T>
void BlockRows<T>::run_sparse(Block& work, FilledRanges& filled) const {
  const auto is_filled = [&](const WorkRange& range) { return filled.contains(range); };
  for (const BlockRow& row : rows_) {
    if (multiply_row(row, work, row.adds && is_filled(row.out), is_filled)) filled.add(row.out);
  }
}

template <class T>
std::size_t BlockRows<T>::bytes(const BlockRow& row) {
  return row.packed ? row.numbers() * sizeof(std::int16_t) + row.scales() * sizeof(float) : row.numbers() * sizeof(T);
}

template <class T>
std::size_t BlockRows<T>::bytes() const {
  std::size_t sum = 0;
  for (const BlockRow& row : rows_) sum += bytes(row);
  return sum;
}

template class BlockRows<float>;
template class BlockRows<double>;

}  // namespace skinbem
