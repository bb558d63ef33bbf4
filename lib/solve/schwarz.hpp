// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Restricted additive Schwarz preconditioner on the leaves of the cluster tree.
#pragma once

#include <skinbem/hmatrix/compressed_matrix.hpp>
#include <skinbem/hmatrix/packed_tiles.hpp>

namespace skinbem {

/// Of H + B B^T. For each leaf the matrix of its vertices and of those around it is inverted and the leaf's rows of the
/// inverse are kept (Cai and Sarkis, SIAM J. Sci. Comput. 21, 1999). Around means within two mean edge lengths and,
/// where the body is thin, as far as the opposite side.
class SchwarzPreconditioner {
 public:
  /// Takes entries of H from its near blocks; B (rigid_modes) in the order of the mesh. Throws Error(numerical) where a
  /// leaf's matrix is singular.
  template <class T>
  SchwarzPreconditioner(const TriangleMesh& mesh, const CompressedMatrix<T>& H, const Eigen::MatrixXd& B);

  /// In the tree's order. The same bits for any number of threads.
  void apply(const VectorBlock& in, VectorBlock& out) const;

  std::size_t bytes() const;

 private:
  struct Leaf {
    Index first = 0;             ///< row of the tree's order
    std::vector<Index> sources;  ///< rows that its rows of the inverse are multiplied with
    PackedTiles inverse;
  };

  /// False for a singular matrix.
  static bool invert(const Eigen::MatrixXf& entries, const Cluster& cluster, const std::vector<std::int32_t>& places,
                     Leaf& leaf);

  std::vector<Leaf> leaves_;
};

}  // namespace skinbem
