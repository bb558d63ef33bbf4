// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Densities of a load on the surface.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include <skinbem/mesh/triangle_mesh.hpp>

namespace skinbem {

/// A scalar density on the surface, sum_i value_i N_i.
struct VertexWeight {
  std::int32_t vertex;
  double value;
};

/// A triangle, or a part of one, with a scalar density that is linear on it.
struct LoadedPiece {
  std::int32_t triangle;
  Mat3 corners;  ///< column k: barycentric coordinates of corner k of the part in the triangle; a whole one: identity
  Vec3 density;  ///< at the part's corners
};

/// The integral of the density over each of the mesh's triangles: #T.
Eigen::VectorXd loads_of_triangles(const TriangleMesh& mesh, std::span<const LoadedPiece> density);
/// int density N_i dS for each vertex i: #V.
Eigen::VectorXd loads_of_vertices(const TriangleMesh& mesh, std::span<const LoadedPiece> density);

}  // namespace skinbem
