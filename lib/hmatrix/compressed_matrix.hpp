// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The double layer's matrix H, compressed: an H2-matrix.
#pragma once

#include <memory>

#include <skinbem/base/progress.hpp>
#include <skinbem/hmatrix/block_rows.hpp>
#include <skinbem/hmatrix/couplings.hpp>
#include <skinbem/hmatrix/exact_rows.hpp>

namespace skinbem {

/// How far H is compressed.
struct CompressionOptions {
  /// Of the nested bases, relative to each cluster's far field; not a bound of the matrix's error, which is measured.
  double tolerance = 1e-3;
  /// Blocks of clusters whose larger diameter is less than eta times their distance are compressed; none for 0, when
  /// the matrix is exact and dense.
  double eta = 1;
  /// Vertices of a cluster's far field that its bases are made from.
  Index samples = 128;
  /// Near blocks and the bases of small clusters are stored in 16 bits, where the others are in single precision: half
  /// the memory. Their rounding errors differ from vertex to vertex and even out; those of larger clusters would not.
  bool packed = false;
};

/// What it took. Sizes in bytes.
struct CompressionSummary {
  std::size_t near_bytes = 0;  ///< blocks of neighbouring leaves, dense
  std::size_t basis_bytes = 0;
  std::size_t coupling_bytes = 0;    ///< skeletons, from which couplings are computed in every product
  std::size_t coupling_numbers = 0;  ///< entries of the couplings
  double mean_rank = 0;              ///< of all bases
  Index exact_vertices = 0;
  double basis_seconds = 0;
  double near_seconds = 0;
};

/// H (3N by 3N) with T = float or double numbers, as near blocks of neighbouring leaves, and for the far field nested
/// bases (interpolative decomposition: Martinsson, Rokhlin, Tygert 2005; nested: Boerm 2010) with couplings that are
/// values of the kernel between two skeletons, computed in every product: H ~ D + near + P S Q^T. Diagonal blocks D
/// make H 1 = 0. Vectors are in the tree's order (tree_row), filled up to a whole panel.
template <class T>
class CompressedMatrix {
 public:
  using Block = typename BlockRows<T>::Block;

  CompressedMatrix(const TriangleMesh& mesh, const Collocation<Kelvin<double>>& collocation,
                   const CompressionOptions& options, const Progress& progress = {});

  /// 3N, filled up to whole panels.
  Index rows() const { return rows_; }
  /// From rows in the order of the mesh to the tree's order, and back. What fills up is zero.
  VectorBlock to_tree(const Eigen::MatrixXd& vectors) const;
  Eigen::MatrixXd from_tree(const VectorBlock& vectors) const;

  /// Y = H X in the tree's order, at most kMostColumns columns. `work` is scratch space that is kept.
  void multiply(const VectorBlock& X, VectorBlock& Y, Block& work) const;
  /// The same by one thread, to be called by several at once, for an X that is zero in most leaves: what would multiply
  /// zeros is left out.
  void multiply_sparse(const VectorBlock& X, VectorBlock& Y, Block& work) const;

  /// Of the rows that are kept as they are.
  const std::vector<std::int32_t>& exact_places() const { return exact_places_; }
  /// The blocks of vertices with themselves, by place.
  const std::vector<Mat3>& diagonal() const { return diagonal_; }
  /// The entries of H between these places of one leaf's neighbourhood: 3 #places squared, degrees of freedom in the
  /// order of the places. Zero for pairs of leaves that are not neighbours.
  Eigen::MatrixXf near_entries(const std::vector<std::int32_t>& places) const;

  const ClusterTree& tree() const { return tree_; }
  const BlockPartition& partition() const { return partition_; }
  const CompressionSummary& summary() const { return summary_; }
  std::size_t bytes() const { return upwards_.bytes() + couplings_.bytes() + downwards_.bytes(); }
  /// Multiplications and additions of a product, by column.
  std::size_t numbers() const { return upwards_.numbers() + couplings_.numbers() + downwards_.numbers(); }

 private:
  static constexpr int components = 3;
  static constexpr double bases_share = 0.6;  ///< of the time

  /// Degrees of freedom of a leaf, filled up to whole panels.
  static WorkRange dofs_of(const Cluster& leaf);

  /// Bases and couplings.
  void compress_far_field(const TriangleMesh& mesh, const Collocation<Kelvin<double>>& collocation,
                          const CompressionOptions& options, const Progress& progress);
  // the layout
  void plan(const NestedBases& bases, const PointKernel<Kelvin<double>>& kernel);
  void plan_upwards(const std::vector<WorkRange>& columns);
  void plan_downwards(const std::vector<WorkRange>& rows);
  void plan_leaves(const std::vector<WorkRange>& rows, Index out);
  /// Whether the numbers of its block rows take 16 bits.
  bool is_packed(const Cluster& cluster) const;
  // the numbers: compressed_numbers.cpp
  void fill_bases(const NestedBases& bases);
  void fill_near(const Collocation<Kelvin<double>>& collocation, const Progress& progress);
  void fill_near_leaf(const Collocation<Kelvin<double>>& collocation, std::int32_t leaf);
  // what is not compressed
  void set_diagonal();
  void keep_exact_rows(const TriangleMesh& mesh, const Collocation<Kelvin<double>>& collocation);
  /// Y from the workspace, the diagonal and the exact rows.
  void finish_product(const VectorBlock& X, const Block& work, VectorBlock& Y) const;
  void multiply_exact_rows(const VectorBlock& X, VectorBlock& Y) const;
  /// Where the neighbour's columns begin in the leaf's block row; -1 where it is none.
  Index near_column(std::int32_t leaf, std::int32_t neighbour) const;

  ClusterTree tree_;
  BlockPartition partition_;
  Index rows_ = 0;
  bool packed_;
  BlockRows<T> upwards_;    ///< coefficients of the columns' skeletons
  Couplings<T> couplings_;  ///< from them those of the rows' skeletons
  BlockRows<T> downwards_;  ///< and what comes out
  std::vector<Mat3> diagonal_;
  std::vector<std::int32_t> exact_places_;
  RowMajorMatrix exact_rows_;  ///< of H: 3 #exact_places by rows, in the tree's order
  std::vector<std::int32_t> leaf_of_place_;
  std::vector<std::int32_t> up_, down_, out_;  ///< block row by cluster, -1 where there is none
  Index work_rows_ = 0;
  CompressionSummary summary_;
};

/// Mean rank of the bases at a tolerance of theirs, as measured on the leg of 10,000 vertices.
double predict_rank(double tolerance);

/// Bytes that a CompressedMatrix of numbers of `number_bytes` each will take: near blocks are counted, the rest follows
/// from that rank.
std::size_t predict_compressed_bytes(const TriangleMesh& mesh, const CompressionOptions& options,
                                     std::size_t number_bytes);

extern template class CompressedMatrix<float>;
extern template class CompressedMatrix<double>;

}  // namespace skinbem
