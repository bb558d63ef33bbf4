// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Normals of the deformed skin: exact from the positions of a frame, or linear in the landmarks as the positions are.
#pragma once

#include <vector>

#include <skinbem/base/types.hpp>
#include <skinbem/frame/vertex_buffer.hpp>

namespace skinbem {

/// Unit vertex normals of a triangle mesh whose vertices move: the sum of the area vectors of the triangles around a
/// vertex, scaled to length 1, outward where the triangles are counter-clockwise seen from outside. A vertex whose
/// triangles sum to nothing gets (0, 0, 0).
class VertexNormals {
 public:
  /// Throws Error(usage) where a triangle names a vertex that does not exist.
  VertexNormals(const Triangles& triangles, Index vertex_count);

  /// Writes the normals for `positions`; both may be attributes of one buffer. No allocation, but uses memory of this
  /// object: one object for each thread. Returns false and writes nothing where an attribute does not hold the
  /// vertices.
  bool evaluate(const VertexSource& positions, const VertexTarget& normals) noexcept;

 private:
  std::vector<std::int32_t> corners_;  // three vertices for each triangle
  std::vector<std::uint32_t> begin_;   // of a vertex in around_; one more than vertices
  std::vector<std::uint32_t> around_;  // triangles around the vertices, in ascending order
  std::vector<float> area_vectors_;    // of the triangles, x, y, z
};

/// The normals as a linear function of the landmarks, n = rest + response q: unit at rest, and to first order in q
/// afterwards. As a FrameModel with FrameOptions::directions they cost what the positions cost and need no triangles.
struct LinearNormals {
  Points rest;               ///< unit normals at rest, #V by 3
  Eigen::MatrixXd response;  ///< 3 #V by #columns, like R
};

/// Derivative of the unit vertex normals at `rest` (#V by 3) for displacements R q. Throws Error(usage) on shapes that
/// do not fit and Error(bad_input) for a vertex without normal.
LinearNormals linear_normals(const Points& rest, const Triangles& triangles, const Eigen::MatrixXd& response);

}  // namespace skinbem
