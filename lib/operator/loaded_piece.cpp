// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/operator/loaded_piece.hpp>

#include <Eigen/LU>
#include <cmath>

namespace skinbem {
namespace {

double area(const TriangleMesh& mesh, const LoadedPiece& piece) {
  return area_vector(mesh, piece.triangle).norm() / 2 * std::abs(piece.corners.determinant());
}

}  // namespace

Eigen::VectorXd loads_of_triangles(const TriangleMesh& mesh, std::span<const LoadedPiece> density) {
  Eigen::VectorXd loads = Eigen::VectorXd::Zero(mesh.triangle_count());
  for (const LoadedPiece& piece : density) loads[piece.triangle] += area(mesh, piece) * piece.density.mean();
  return loads;
}

Eigen::VectorXd loads_of_vertices(const TriangleMesh& mesh, std::span<const LoadedPiece> density) {
  Eigen::VectorXd loads = Eigen::VectorXd::Zero(mesh.vertex_count());
  for (const LoadedPiece& piece : density) {
    // of two linear functions f and g: area / 12 (sum f sum g + sum f g), over the corners
    const Vec3 of_hats =
        area(mesh, piece) / 12 * (piece.density.sum() * piece.corners.rowwise().sum() + piece.corners * piece.density);
    for (int c = 0; c < 3; ++c) loads[mesh.triangles(piece.triangle, c)] += of_hats[c];
  }
  return loads;
}

}  // namespace skinbem
