// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The closed triangle surface that bounds the body.
#pragma once

#include <skinbem/base/types.hpp>

namespace skinbem {

/// Vertices in the order of their file; triangles counter-clockwise seen from outside the body.
/// A plain value: nothing is validated here (see validate.hpp).
struct TriangleMesh {
  Points vertices;      ///< #V by 3, unit of length of the model
  Triangles triangles;  ///< #T by 3, indices into vertices

  Index vertex_count() const { return vertices.rows(); }
  Index triangle_count() const { return triangles.rows(); }
  /// Position of corner `corner` (0, 1, 2) of triangle `t`.
  Vec3 corner(Index t, int corner) const { return vertices.row(triangles(t, corner)); }
};

/// Enclosed volume by the divergence theorem: positive when the triangles face outward.
double volume(const TriangleMesh& mesh);
/// Twice the area of triangle `t` times its outward unit normal.
Vec3 area_vector(const TriangleMesh& mesh, Index t);
/// Length of the bounding box's diagonal: "the size" of the mesh wherever a tolerance is relative to it.
double diagonal(const TriangleMesh& mesh);
/// The power of two, so that scaling is exact, that brings the diagonal between 1/2 and 1.
double unit_scale(const TriangleMesh& mesh);
/// #V: a third of the area of the triangles around each vertex.
Eigen::VectorXd vertex_areas(const TriangleMesh& mesh);

}  // namespace skinbem
