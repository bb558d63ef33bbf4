// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What neighbourhoods cannot see: parts of the body that move against each other.
#pragma once

#include <Eigen/LU>

#include <skinbem/hmatrix/compressed_matrix.hpp>
#include <skinbem/hmatrix/packed_tiles.hpp>
#include <skinbem/solve/block_gmres.hpp>

namespace skinbem {

/// Vertices nearest, in edges to walk, to one of at most `count` that are as far apart as can be: ends of limbs,
/// fingers and toes come first, so that each is a part of its own.
std::vector<std::vector<std::int32_t>> parts_of_skin(const TriangleMesh& mesh, std::size_t count);

/// The coarse level of a preconditioner: the rigid motions of some parts of the body, each by itself, on which
/// A = H + B B^T is inverted. With M a preconditioner of neighbourhoods, Z the motions and E = Z^T A Z,
///   M (I - A Z E^-1 Z^T) + Z E^-1 Z^T
/// bends a limb as easily as M alone moves a patch of its skin. (A-DEF1 of Tang, Nabben, Vuik, Erlangga, Comparison of
/// two-level preconditioners, J. Sci. Comput. 39, 2009.)
class CoarseCorrection {
 public:
  /// More for a finer skin, of which Schwarz's neighbourhoods cover less.
  static std::size_t parts_for(Index vertices);

  /// B in the tree's order. Throws Error(numerical) where E is singular.
  template <class T>
  CoarseCorrection(const TriangleMesh& mesh, const CompressedMatrix<T>& H, const VectorBlock& B, std::size_t parts);

  /// out = Z E^-1 Z^T in; what A makes of it is taken from `in`.
  void apply(VectorBlock& in, VectorBlock& out) const;

 private:
  using SingleRows = Eigen::Matrix<float, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  struct Part {
    std::vector<Index> rows;  ///< in the tree's order
    VectorBlock Z;            ///< #rows by 6, orthonormal columns
  };
  Index width() const { return 6 * Index(parts_.size()); }
  /// What A makes of the motions of part k, 6 columns.
  void set_product(std::size_t k, const VectorBlock& AZ);
  void add_part(const TriangleMesh& mesh, const std::vector<std::int32_t>& vertices,
                const std::vector<std::int32_t>& places);
  /// Z^T V and Z S; the latter into rows of parts only.
  Eigen::MatrixXd restrict_to_parts(const VectorBlock& V) const;
  void prolong(const Eigen::MatrixXd& S, VectorBlock& V) const;

  std::vector<Part> parts_;
  PackedTiles AZ_;  ///< rows in the tree's order
  Eigen::PartialPivLU<Eigen::MatrixXd> E_;
};

extern template CoarseCorrection::CoarseCorrection(const TriangleMesh&, const CompressedMatrix<float>&,
                                                   const VectorBlock&, std::size_t);
extern template CoarseCorrection::CoarseCorrection(const TriangleMesh&, const CompressedMatrix<double>&,
                                                   const VectorBlock&, std::size_t);

}  // namespace skinbem
