// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Nested bases of an H2-matrix by interpolative decomposition against samples of the far field.
#pragma once

#include <functional>

#include <skinbem/hmatrix/far_field.hpp>

namespace skinbem {

/// One component at the vertex of a place, or of the dipole of a triangle.
struct Dof {
  std::int32_t point;
  std::int32_t component;
};

/// The points of some degrees of freedom, each once, and where in that list each one's point is.
struct PointList {
  std::vector<std::int32_t> points;
  std::vector<std::size_t> of_dof;

  explicit PointList(const std::vector<Dof>& dofs);
};

/// What a cluster shows to its far field: of its candidates it keeps a skeleton, from which its degrees of freedom
/// follow. Rows: candidates are a leaf's vertices. Columns: dipoles of the triangles around them. Above the leaves:
/// what the two children kept.
struct ClusterBasis {
  /// Of columns in the order of DipoleColumns.
  std::vector<Dof> skeleton;
  /// #degrees of freedom by #skeleton: their rows of the far field from the skeleton's, or the transpose for columns.
  /// Degrees of freedom: of a leaf, as in a tile, by panel, component, vertex, filled up to whole panels with zeros;
  /// otherwise the two children's skeletons, one after the other.
  Eigen::MatrixXd interpolation;
};

/// By cluster; empty where there is no far field.
struct NestedBases {
  std::vector<ClusterBasis> rows;     ///< field at the cluster's vertices from that at its skeleton
  std::vector<ClusterBasis> columns;  ///< dipoles that act as the cluster's hat functions do
};

struct BasisOptions {
  /// Frobenius norm of what the skeleton misses of the sampled far field, relative.
  double tolerance = 1e-3;
  Index samples = 128;
};

/// Bottom-up, all clusters of a level in parallel; the same bits for any number of threads. Each basis is checked
/// against samples that it was not made from, and made anew from twice as many where it misses more than twice the
/// tolerance of them. Calls done(fraction) after each level.
template <class Kernel>
NestedBases make_nested_bases(const TriangleMesh& mesh, const ClusterTree& tree, const BlockPartition& partition,
                              const Collocation<Kernel>& collocation, const PointKernel<Kernel>& kernel,
                              const BasisOptions& options, const std::function<void(double)>& done);

/// Columns of a matrix that the others follow from.
struct ColumnSelection {
  std::vector<std::int32_t> columns;
  Eigen::MatrixXd weights;  ///< #rows of the Gram matrix by #columns kept
};

/// Interpolative decomposition of A from its Gram matrix, A ~ A(:, columns) weights^T: pivoted Cholesky until
/// |A - ...|_F <= tolerance |A|_F, and on to a multiple of kTileStep columns while that makes sense. `gram` is A^T A (n
/// by n, the lower half is read), or below it C^T A for further columns C that are to be expressed by those of A.
ColumnSelection select_columns(const Eigen::Ref<const Eigen::MatrixXd>& gram, double tolerance);

extern template NestedBases make_nested_bases(const TriangleMesh&, const ClusterTree&, const BlockPartition&,
                                              const Collocation<Kelvin<double>>&, const PointKernel<Kelvin<double>>&,
                                              const BasisOptions&, const std::function<void(double)>&);

}  // namespace skinbem
