// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The couplings of an H2-matrix: what the dipoles of one cluster's skeleton do at the vertices of another's.
#pragma once

#include <array>
#include <vector>

#include <skinbem/base/aligned_buffer.hpp>
#include <skinbem/hmatrix/block_rows.hpp>
#include <skinbem/hmatrix/nested_basis.hpp>

namespace skinbem {

/// Coefficients of row skeletons from those of the column skeletons of far clusters. Couplings are values of the
/// kernel, which every product computes anew. Stored, they would take as much memory as the near blocks, and filling
/// them as long as the products of a solve would then save (docs/hmatrix.md).
template <class T>
class Couplings {
 public:
  using Block = typename BlockRows<T>::Block;

  Couplings() = default;
  /// `rows` and `columns` say where the clusters' coefficients are in the workspace. Columns of a cluster's skeleton
  /// are in the order of DipoleColumns.
  Couplings(const PointKernel<Kelvin<double>>& kernel, const NestedBases& bases, const BlockPartition& partition,
            std::vector<WorkRange> rows, std::vector<WorkRange> columns);

  /// Writes the coefficients of every cluster that has far partners. The same bits for any number of threads.
  void run(Block& work) const;
  /// The same as BlockRows::run_sparse.
  void run_sparse(Block& work, FilledRanges& filled) const;

  bool has_partners(std::int32_t cluster) const { return !far_[cluster].empty(); }
  /// Entries of all couplings.
  std::size_t numbers() const;
  /// Of the skeletons.
  std::size_t bytes() const;

 private:
  /// Of a cluster's rows: x, y, z and component, each filled up to a multiple of kTileStep.
  struct RowSkeleton {
    std::size_t count = 0;
    std::vector<double> numbers;
  };
  /// Consecutive columns of a skeleton, at most kDepth.
  struct Slice {
    std::array<std::size_t, 8> with;  ///< dipoles by set of components, as DipoleColumns
    std::size_t first_dipole, first_column, columns;
  };
  /// Of a cluster's columns, relative to its centre: x, y, z and normal of the dipoles.
  struct ColumnSkeleton {
    Vec3 centre;
    std::size_t count = 0;  ///< dipoles
    detail::AlignedVector<T> numbers;
    std::vector<Slice> slices;

    DipoleColumns<T> columns_of(const Slice& slice) const;
  };

  static RowSkeleton skeleton_of_rows(const PointKernel<Kelvin<double>>& kernel, const std::vector<Dof>& dofs);
  static ColumnSkeleton skeleton_of_columns(const PointKernel<Kelvin<double>>& kernel, const std::vector<Dof>& dofs);
  /// From the partners that are wanted; false where there are none.
  template <class Wanted>
  bool multiply_cluster(std::size_t cluster, Block& work, const Wanted& wanted) const;

  Kelvin<double> kernel_;
  std::vector<std::vector<std::int32_t>> far_;
  std::vector<WorkRange> row_range_, column_range_;
  std::vector<RowSkeleton> rows_;
  std::vector<ColumnSkeleton> columns_;
};

extern template class Couplings<float>;
extern template class Couplings<double>;

}  // namespace skinbem
