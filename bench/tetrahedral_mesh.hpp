// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Tetrahedra in the body that a skin bounds, made by TetGen (AGPL: a program linked with it is AGPL as a whole).
#pragma once

#include <string>

#include <skinbem/mesh/adjacency.hpp>
#include <skinbem/mesh/triangle_mesh.hpp>

namespace skinbem::bench {

/// Four node indices a tetrahedron, positively oriented: (b - a) x (c - a) . (d - a) > 0.
using Tetrahedra = Eigen::Matrix<std::int32_t, Eigen::Dynamic, 4, Eigen::RowMajor>;

struct TetrahedralMesh {
  Points nodes;  ///< the vertices of the skin first, in their order; then the nodes inside
  Tetrahedra tetrahedra;
};

/// Fills the body with tetrahedra whose boundary is the skin, triangle for triangle. `quality`: TetGen's switches
/// beside p (fill), Y (keep the skin) and Q (quiet): q, a bound of circumradius over shortest edge, and a, the largest
/// volume, here in cubes of the skin's mean edge. Throws Error(bad_input) where TetGen cannot.
TetrahedralMesh fill_with_tetrahedra(const TriangleMesh& skin, const std::string& quality);

/// #nodes lists: the tetrahedra that have the node as a corner, ascending.
IndexLists tetrahedra_around_nodes(const TetrahedralMesh& mesh);

}  // namespace skinbem::bench
