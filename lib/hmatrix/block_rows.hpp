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

/// out = A times the stacked `sources`.
struct BlockRow {
  WorkRange out;  ///< the length a multiple of kTileStep
  std::vector<WorkRange> sources;
  Index width = 0;  ///< sum of the sources' lengths
  std::size_t offset = 0;

  std::size_t numbers() const { return static_cast<std::size_t>(out.length * width); }
};

/// Rows of one stage do not depend on each other and are computed in parallel; each stage reads what earlier ones
/// wrote.
template <class T>
class BlockRows {
 public:
  using Block = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// Rows that are added from now on belong to a new stage.
  void begin_stage() { stages_.push_back(rows_.size()); }
  /// Its number.
  std::size_t add(WorkRange out, std::vector<WorkRange> sources);
  /// After the last row: storage for the numbers of all of them, not initialised.
  void allocate();

  const BlockRow& row(std::size_t k) const { return rows_[k]; }
  /// Column k of the tile that holds row `r` of the block row; the tile's numbers of that column are adjacent.
  T* tile_column(std::size_t row, Index r, Index k) {
    const BlockRow& b = rows_[row];
    const Index tile = r / Index(kTile), first = tile * Index(kTile);
    return numbers_.data() + b.offset + first * b.width + k * std::min(Index(kTile), b.out.length - first);
  }
  const T* tile_column(std::size_t row, Index r, Index k) const {
    return const_cast<BlockRows*>(this)->tile_column(row, r, k);
  }

  /// Runs the schedule over a workspace (rows by at most kMostColumns, row-major). The same bits for any number of
  /// threads.
  void run(Block& work) const;

  std::size_t size() const { return rows_.size(); }
  std::size_t bytes() const { return numbers_.size() * sizeof(T); }

 private:
  std::vector<BlockRow> rows_;
  std::vector<std::size_t> stages_;  ///< first row of each
  detail::Uninitialised<T> numbers_;
};

extern template class BlockRows<float>;
extern template class BlockRows<double>;

}  // namespace skinbem
