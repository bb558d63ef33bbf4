// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// How triangles hang together along their edges.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <skinbem/mesh/triangle_mesh.hpp>

namespace skinbem {

/// An edge that does not lie in exactly two triangles.
struct OddEdge {
  std::array<std::int32_t, 2> vertices;
  std::int32_t triangle;  ///< the first it lies in
  Index triangles;        ///< how many it lies in
};

/// Numbers are those of the mesh; only the triangles asked for take part.
struct SurfaceTopology {
  std::vector<OddEdge> open_edges, crowded_edges;  ///< in one triangle, in more than two; ascending
  std::vector<std::int32_t> pinched_vertices;      ///< whose triangles form several fans; ascending
  std::vector<std::int32_t> flipped;  ///< triangles to turn for each component to become consistent, ascending
  std::vector<std::array<std::int32_t, 2>> one_sided;  ///< edges where no turning helps: the surface has one side
  std::vector<std::int32_t> component;                 ///< #T: edge-connected component, by lowest triangle; -1 outside
  std::int32_t component_count = 0;
};

/// `triangles`, ascending, must have three different vertices each. O(T log T).
SurfaceTopology surface_topology(const TriangleMesh& mesh, const std::vector<std::int32_t>& triangles);

}  // namespace skinbem
