// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What linear interpolation misses of a displacement between the vertices.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <skinbem/mesh/adjacency.hpp>
#include <skinbem/operator/loaded_piece.hpp>

namespace skinbem {

/// A value and where it belongs.
template <class Value>
struct Indexed {
  std::int32_t index;
  Value value;
};

/// A row of a sparse matrix of 3 by 3 blocks: by column, each once, in no order.
using SparseBlockRow = std::vector<Indexed<Mat3>>;

/// The curvature of displacements, recovered from their gradients at the vertices.
///
/// Along an edge from a to b a smooth displacement departs from the line between its ends by 4 l (1 - l) m at the share
/// l of the way, m = (grad u_a - grad u_b) (b - a) / 8 (Hermite's cubic). grad u_a is the mean, by area, of the
/// gradients on the triangles around a: within the triangle's plane that of linear interpolation, across it from the
/// traction by Hooke's law. Such a bow has the integral A m / 3 over a triangle of area A; with half of it given to the
/// hat function of each of its ends, vertex k gets
///
///   s_k = sum A (m + m') / 2 / sum A   over the triangles around k, m and m' those of their edges at k,
///
/// linear in the displacement and in the mean traction on each triangle: s = S u + S_t t. It vanishes where the strain
/// is constant. The double layer sees bows as it sees s, but for the free term C, since they vanish at the vertices:
///
///   (H + (H - C) S) u = G t - (H - C) S_t t.
///
/// Fields that are known come out with an error of a fifteenth to a half of that of H u = G t (docs/accuracy.md). After
/// the gradient recovery of finite elements (O. C. Zienkiewicz, J. Z. Zhu, The superconvergent patch recovery,
/// International Journal for Numerical Methods in Engineering 33, 1992), here within the equation.
class RecoveredCurvature {
 public:
  /// Copies what it needs of the mesh, which must bound a body. Poisson's ratio in (-1, 0.5], shear modulus 1.
  RecoveredCurvature(const TriangleMesh& mesh, double poisson);

  /// The rows of S, one a vertex.
  const std::vector<SparseBlockRow>& of_displacements() const { return S_; }
  /// S V, V of 3N rows in the order of the mesh.
  Eigen::MatrixXd of_displacements(const Eigen::MatrixXd& V) const;
  /// S_t t, 3N, for the mean traction on each triangle, #T by 3.
  Eigen::VectorXd of_tractions(const Points& tractions) const;
  /// The same for unit tractions along x, y and z times a density: 3N by 3, as Collocation::single_layer_columns.
  Eigen::MatrixXd of_tractions(std::span<const LoadedPiece> density) const;
  /// C, a block for each vertex.
  const std::vector<Mat3>& free_terms() const { return free_terms_; }
  /// C V.
  Eigen::MatrixXd free_part(const Eigen::MatrixXd& V) const;

 private:
  /// Calls visit(t, n, d) for each triangle t around a vertex's neighbours, n its normal: the sum of (gradient of u on
  /// t) times d is the vertex's s.
  template <class Visit>
  void for_each_gradient(Index vertex, const Visit& visit) const;
  SparseBlockRow row_of(Index vertex) const;

  TriangleMesh mesh_;  ///< scaled to unit size
  double scale_, poisson_;
  IndexLists triangles_of_vertex_;
  Eigen::VectorXd vertex_areas_;
  std::vector<Mat3> free_terms_;
  std::vector<SparseBlockRow> S_;
};

}  // namespace skinbem
