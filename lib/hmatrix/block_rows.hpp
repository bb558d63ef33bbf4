// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A matrix in factored form as a schedule: stages of block rows, each block row a packed matrix whose right-hand sides
/// lie here and there in one workspace.
#pragma once

#include <cstdint>
#include <vector>

#include <skinbem/base/aligned_buffer.hpp>
#include <skinbem/base/types.hpp>
#include <skinbem/hmatrix/tile_product.hpp>

namespace skinbem {

/// Consecutive rows of the workspace.
struct WorkRange {
  Index first;
  Index length;
};

/// The next multiple of `step`.
inline Index round_up(Index n, std::size_t step) { return (n + Index(step) - 1) / Index(step) * Index(step); }

/// Which ranges of a workspace hold anything but zeros; each is known by its first row, a multiple of kTileStep.
class FilledRanges {
 public:
  explicit FilledRanges(Index rows) : filled_(std::size_t(rows) / kTileStep, false) {}
  bool contains(const WorkRange& range) const { return filled_[std::size_t(range.first) / kTileStep]; }
  void add(const WorkRange& range) { filled_[std::size_t(range.first) / kTileStep] = true; }

 private:
  std::vector<bool> filled_;
};

/// out = A times the stacked `sources`, or out += that.
struct BlockRow {
  WorkRange out;  ///< the length a multiple of kTileStep
  std::vector<WorkRange> sources;
  bool packed = false;           ///< numbers in 16 bits (PackedTile)
  bool adds = false;             ///< to what is there
  Index width = 0;               ///< sum of the sources' lengths
  std::size_t offset = 0;        ///< of its numbers among those of its kind
  std::size_t scale_offset = 0;  ///< of its tiles' scales, where it is packed

  std::size_t numbers() const { return static_cast<std::size_t>(out.length * width); }
  std::size_t scales() const {
    return packed ? static_cast<std::size_t>((out.length + Index(kTile) - 1) / Index(kTile) * width) : 0;
  }
};

/// Rows of one stage do not depend on each other and are computed in parallel; each stage reads what earlier ones
/// wrote.
template <class T>
class BlockRows {
 public:
  using Block = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// Rows that are added from now on belong to a new stage.
  void begin_stage() { stages_.push_back(rows_.size()); }
  /// Its number. Numbers in double are never packed; offsets and width are set here and by allocate().
  std::size_t add(BlockRow row);
  /// After the last row: storage for the numbers of all of them, not initialised.
  void allocate();

  const BlockRow& row(std::size_t k) const { return rows_[k]; }
  /// Column k of the tile that begins with row `first` of the block row: as many values as the tile has rows, which
  /// become what rounding loses of them.
  void set_column(std::size_t row, Index first, Index k, T* values);
  void get_column(std::size_t row, Index first, Index k, T* values) const;

  /// Runs the schedule over a workspace (rows by at most kMostColumns, row-major). The same bits for any number of
  /// threads.
  void run(Block& work) const;
  /// The same by one thread, for a workspace that is zero but for what is `filled`; nothing else is read or multiplied.
  /// What is written is filled from then on.
  void run_sparse(Block& work, FilledRanges& filled) const;

  std::size_t size() const { return rows_.size(); }
  std::size_t numbers() const { return numbers_.size() + packed_.size(); }
  std::size_t bytes() const;
  /// Of one row.
  static std::size_t bytes(const BlockRow& row);

 private:
  /// From the sources that are wanted, added to what is there or not; false where there are none.
  template <class Wanted>
  bool multiply_row(const BlockRow& row, Block& work, bool adds, const Wanted& wanted) const;
  void multiply_tile_of(const BlockRow& row, Index first, Index column, std::span<const RowRange<T>> ranges,
                        Index columns, T* out) const;

  std::vector<BlockRow> rows_;
  std::vector<std::size_t> stages_;  ///< first row of each
  detail::Uninitialised<T> numbers_;
  detail::Uninitialised<std::int16_t> packed_;
  detail::Uninitialised<float> scales_;
};

extern template class BlockRows<float>;
extern template class BlockRows<double>;

}  // namespace skinbem
