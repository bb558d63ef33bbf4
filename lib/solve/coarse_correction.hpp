// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What neighbourhoods cannot see: parts of the body that move against each other.
#pragma once

#include <Eigen/LU>

#include <skinbem/hmatrix/cluster_tree.hpp>
#include <skinbem/solve/block_gmres.hpp>

namespace skinbem {

/// The coarse level of a preconditioner: the rigid motions of some parts of the body, each by itself, on which A is
/// inverted. With M a preconditioner of neighbourhoods, Z the motions and E = Z^T A Z,
///   M (I - A Z E^-1 Z^T) + Z E^-1 Z^T
/// bends a limb as easily as M alone moves a patch of its skin. (A-DEF1 of Tang, Nabben, Vuik, Erlangga, Comparison of
/// two-level preconditioners, J. Sci. Comput. 39, 2009.)
class CoarseCorrection {
 public:
  /// Parts of about equal size, six motions each: what A takes at once.
  static constexpr std::size_t default_parts = 8;

  /// One product with A, which keeps the tree's order of vectors of `rows` rows. Throws Error(numerical) where E is
  /// singular.
  CoarseCorrection(const TriangleMesh& mesh, const ClusterTree& tree, Index rows, const BlockOperator& A,
                   std::size_t parts = default_parts);

  /// out = Z E^-1 Z^T in; what A makes of it is taken from `in`.
  void apply(VectorBlock& in, VectorBlock& out) const;

 private:
  struct Part {
    Index first;    ///< row
    VectorBlock Z;  ///< its rows by 6, orthonormal columns
  };
  Index width() const { return 6 * Index(parts_.size()); }
  /// Z^T V and Z S.
  Eigen::MatrixXd restrict_to_parts(const VectorBlock& V) const;
  void prolong(const Eigen::MatrixXd& S, VectorBlock& V) const;

  std::vector<Part> parts_;
  VectorBlock AZ_;
  Eigen::PartialPivLU<Eigen::MatrixXd> E_;
};

}  // namespace skinbem
