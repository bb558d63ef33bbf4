// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/hmatrix/block_rows.hpp>

namespace skinbem {
namespace {

template <class T>
void multiply_row(const BlockRow& row, const T* numbers, typename BlockRows<T>::Block& work) {
  thread_local std::vector<RowRange<T>> ranges;
  ranges.clear();
  for (const WorkRange& source : row.sources) {
    ranges.push_back({work.data() + source.first * work.cols(), static_cast<std::size_t>(source.length)});
  }
  for (Index first = 0; first < row.out.length; first += Index(kTile)) {
    const Index height = std::min(Index(kTile), row.out.length - first);
    multiply_tile(numbers + row.offset + first * row.width, static_cast<std::size_t>(height),
                  std::span<const RowRange<T>>(ranges), static_cast<std::size_t>(work.cols()),
                  work.data() + (row.out.first + first) * work.cols());
  }
}

}  // namespace

template <class T>
std::size_t BlockRows<T>::add(WorkRange out, std::vector<WorkRange> sources) {
  BlockRow row{out, std::move(sources)};
  for (const WorkRange& source : row.sources) row.width += source.length;
  rows_.push_back(std::move(row));
  return rows_.size() - 1;
}

template <class T>
void BlockRows<T>::allocate() {
  std::size_t total = 0;
  for (BlockRow& row : rows_) {
    row.offset = total;
    total += row.numbers();
  }
  numbers_ = detail::Uninitialised<T>(total);
}

template <class T>
void BlockRows<T>::run(Block& work) const {
#pragma omp parallel
  for (std::size_t s = 0; s < stages_.size(); ++s) {
    const std::size_t last = s + 1 < stages_.size() ? stages_[s + 1] : rows_.size();
#pragma omp for schedule(dynamic, 1)
    for (std::size_t k = stages_[s]; k < last; ++k) multiply_row(rows_[k], numbers_.data(), work);
  }
}

template class BlockRows<float>;
template class BlockRows<double>;

}  // namespace skinbem
