// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What a mesh file holds before it is a triangle mesh: points, and faces of any number of corners.
#pragma once

#include <cstdint>
#include <string>
#include <vector>

#include <skinbem/mesh/triangle_mesh.hpp>

namespace skinbem {

/// Points and faces as read, with the place in the file of each face for messages.
struct PolygonSoup {
  std::string name;                     ///< of the file
  bool places_are_bytes = false;        ///< places are byte offsets, not line numbers
  std::int32_t first_index = 0;         ///< of the file's own numbering: 1 for OBJ
  std::vector<double> coordinates{};    ///< 3 a point
  std::vector<std::int64_t> corners{};  ///< 0-based vertex indices of all faces, one after the other
  std::vector<std::size_t> ends{};      ///< per face, behind its last corner
  std::vector<std::int64_t> places{};   ///< per face

  std::int64_t vertex_count() const { return static_cast<std::int64_t>(coordinates.size() / 3); }
  void add_vertex(double x, double y, double z) { coordinates.insert(coordinates.end(), {x, y, z}); }
  /// Makes a face of the corners added since the last one.
  void end_face(std::int64_t place) {
    ends.push_back(corners.size());
    places.push_back(place);
  }
};

/// Triangles in the order of the faces, vertices in the order of the file. Faces of more than three corners are split
/// by clipping, again and again, the ear of best shape in the plane of the face, so faces that are not convex come out
/// right, and a square is split along the diagonal from its first corner.
/// Throws Error(bad_input) with the place for a face of fewer than three or more than 1000 corners, an index out of
/// range, a vertex twice in a face; and when there are no vertices or no faces.
TriangleMesh triangulated(const PolygonSoup& soup);

}  // namespace skinbem
