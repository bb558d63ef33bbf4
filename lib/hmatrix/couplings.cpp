// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/hmatrix/couplings.hpp>

#include <algorithm>
#include <bit>

#include <skinbem/kernels/kelvin_batch.hpp>

namespace skinbem {
namespace {

/// One point of a skeleton and which of its components are in it.
struct DipoleSet {
  std::int32_t triangle;
  unsigned set;
};

/// Of columns in the order of DipoleColumns.
std::vector<DipoleSet> dipole_sets(const std::vector<Dof>& dofs) {
  std::vector<DipoleSet> sets;
  for (const Dof& dof : dofs) {
    if (sets.empty() || sets.back().triangle != dof.point) sets.push_back({dof.point, 0});
    sets.back().set |= 1u << dof.component;
  }
  return sets;
}

/// Rows of a tile as they are seen from another cluster's centre.
template <class T>
struct ShiftedRows {
  alignas(64) T numbers[4][kTile];

  /// `from`: x, y, z and component, `stride` apart. The centre is subtracted before numbers are rounded: its own
  /// rounding would move all rows together, which a thin body sees.
  ShiftedRows(const double* from, std::size_t stride, std::size_t height, const Vec3& centre) {
    for (int k = 0; k < 4; ++k) {
      const double subtracted = k < 3 ? centre[k] : 0;
      for (std::size_t r = 0; r < height; ++r) {
        numbers[k][r] = static_cast<T>(from[std::size_t(k) * stride + r] - subtracted);
      }
    }
  }
  FieldRows<T> rows(std::size_t height) const { return {height, numbers[0], numbers[1], numbers[2], numbers[3]}; }
};

}  // namespace

template <class T>
Couplings<T>::Couplings(const PointKernel<Kelvin<double>>& kernel, const NestedBases& bases,
                        const BlockPartition& partition, std::vector<WorkRange> rows, std::vector<WorkRange> columns)
    : kernel_(kernel.kernel()), far_(partition.far), row_range_(std::move(rows)), column_range_(std::move(columns)) {
  for (const ClusterBasis& basis : bases.rows) rows_.push_back(skeleton_of_rows(kernel, basis.skeleton));
  for (const ClusterBasis& basis : bases.columns) columns_.push_back(skeleton_of_columns(kernel, basis.skeleton));
}

template <class T>
auto Couplings<T>::skeleton_of_rows(const PointKernel<Kelvin<double>>& kernel, const std::vector<Dof>& dofs)
    -> RowSkeleton {
  if (dofs.empty()) return {};
  RowSkeleton result{static_cast<std::size_t>(round_up(Index(dofs.size()), kTileStep)), {}};
  result.numbers.resize(4 * result.count);
  for (std::size_t r = 0; r < result.count; ++r) {
    const Dof& dof = dofs[std::min(r, dofs.size() - 1)];
    for (std::size_t k = 0; k < 3; ++k) {
      result.numbers[k * result.count + r] = kernel.vertex(dof.point)[Index(k)];
    }
    result.numbers[3 * result.count + r] = dof.component;
  }
  return result;
}

template <class T>
auto Couplings<T>::skeleton_of_columns(const PointKernel<Kelvin<double>>& kernel, const std::vector<Dof>& dofs)
    -> ColumnSkeleton {
  const std::vector<DipoleSet> dipoles = dipole_sets(dofs);
  ColumnSkeleton result{Vec3::Zero(), dipoles.size(), {}, {}};
  for (const DipoleSet& dipole : dipoles) result.centre += kernel.centroid(dipole.triangle) / double(dipoles.size());
  result.numbers.resize(6 * dipoles.size());
  std::size_t column = 0;
  for (std::size_t q = 0; q < dipoles.size(); ++q) {
    const auto [triangle, set] = dipoles[q];
    const Vec3 place = kernel.centroid(triangle) - result.centre, normal = kernel.normal(triangle);
    for (std::size_t k = 0; k < 3; ++k) {
      result.numbers[k * dipoles.size() + q] = static_cast<T>(place[Index(k)]);
      result.numbers[(3 + k) * dipoles.size() + q] = static_cast<T>(normal[Index(k)]);
    }
    const std::size_t components = static_cast<std::size_t>(std::popcount(set));
    if (result.slices.empty() || result.slices.back().columns + components > kDepth) {
      result.slices.push_back({{}, q, column, 0});
    }
    ++result.slices.back().with[set];
    result.slices.back().columns += components;
    column += components;
  }
  return result;
}

template <class T>
DipoleColumns<T> Couplings<T>::ColumnSkeleton::columns_of(const Slice& slice) const {
  const auto from = [&](std::size_t k) { return numbers.data() + k * count + slice.first_dipole; };
  return {slice.with, from(0), from(1), from(2), {from(3), from(4), from(5)}};
}

template <class T>
template <class Wanted>
bool Couplings<T>::multiply_cluster(std::size_t cluster, Block& work, const Wanted& wanted) const {
  alignas(64) thread_local T slice_numbers[kTile * kDepth];
  alignas(64) thread_local T sums[kTile * kMostColumns];
  const RowSkeleton& rows = rows_[cluster];
  const std::vector<std::int32_t>& far = far_[cluster];
  const auto is_wanted = [&](std::int32_t partner) { return wanted(column_range_[partner]); };
  if (std::none_of(far.begin(), far.end(), is_wanted)) return false;
  const std::size_t columns = static_cast<std::size_t>(work.cols());
  for (std::size_t first = 0; first < rows.count; first += kTile) {
    const std::size_t height = std::min(kTile, rows.count - first);
    std::fill_n(sums, kTile * columns, T(0));
    for (const std::int32_t partner : far) {
      if (!is_wanted(partner)) continue;
      const ColumnSkeleton& skeleton = columns_[partner];
      const ShiftedRows<T> shifted(rows.numbers.data() + first, rows.count, height, skeleton.centre);
      for (const Slice& slice : skeleton.slices) {
        dipole_matrix(kernel_, shifted.rows(height), skeleton.columns_of(slice), slice_numbers);
        const T* rhs = work.row(column_range_[partner].first + Index(slice.first_column)).data();
        add_slice(slice_numbers, height, slice.columns, rhs, columns, sums);
      }
    }
    store_sums(sums, height, columns, work.row(row_range_[cluster].first + Index(first)).data());
  }
  return true;
}

template <class T>
void Couplings<T>::run(Block& work) const {
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t c = 0; c < far_.size(); ++c) multiply_cluster(c, work, [](const WorkRange&) { return true; });
}

template <class T>
void Couplings<T>::run_sparse(Block& work, FilledRanges& filled) const {
  const auto is_filled = [&](const WorkRange& range) { return filled.contains(range); };
  for (std::size_t c = 0; c < far_.size(); ++c) {
    if (multiply_cluster(c, work, is_filled)) filled.add(row_range_[c]);
  }
}

template <class T>
std::size_t Couplings<T>::numbers() const {
  std::size_t sum = 0;
  for (std::size_t c = 0; c < far_.size(); ++c) {
    for (const std::int32_t partner : far_[c]) {
      sum += rows_[c].count * static_cast<std::size_t>(column_range_[partner].length);
    }
  }
  return sum;
}

template <class T>
std::size_t Couplings<T>::bytes() const {
  std::size_t sum = 0;
  for (const RowSkeleton& rows : rows_) sum += rows.numbers.size() * sizeof(double);
  for (const ColumnSkeleton& columns : columns_) sum += columns.numbers.size() * sizeof(T);
  return sum;
}

template class Couplings<float>;
template class Couplings<double>;

}  // namespace skinbem
