// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What a landmark is on the mesh: the density of its traction and the functional that measures its displacement.
#pragma once

#include <vector>

#include <skinbem/mesh/adjacency.hpp>
#include <skinbem/operator/loaded_piece.hpp>
#include <skinbem/response/landmark.hpp>

namespace skinbem {

/// How a landmark's traction is spread over its patch.
enum class Loads {
  linear,  ///< linear between the vertices
  smooth,  ///< as phi itself: a patch may be smaller than the triangles it lies on
};

/// With phi(s) = (1 - s^2)^2 for s < 1 and d the distance from the landmark's vertex, over the connected patch around
/// it: traction t = phi(d / radius) t_k, measured displacement m_k(u) = sum_i w_i u_i, sum w_i = 1.
///
/// Linear: t = sum_i phi(d_i / radius) N_i t_k and w_i proportional to phi(d_i / radius) a_i, a_i a third of the area
/// around vertex i; a radius below the shortest edge at the vertex leaves one hat function and the nodal value.
/// Smooth: phi is linear on parts of triangles with sides of up to a quarter of the radius, and w_i such that sum_i w_i
/// u_i is the mean of phi u to the second order (docs/theory.md, section 4); a radius below a hundredth of the shortest
/// edge at the vertex is as in linear.
struct LandmarkPatch {
  std::vector<LoadedPiece> traction;      ///< phi, 1 at the landmark's vertex
  std::vector<VertexWeight> measurement;  ///< w_i

  /// m_k of a field: #V by any number of values a vertex.
  Vec3 measure(const Eigen::Ref<const Points>& field) const;
};

/// `triangles_of_vertex` and `vertex_areas` as of adjacency.hpp and triangle_mesh.hpp. Throws Error(bad_input) for a
/// vertex that is not on the mesh, Error(usage) for a radius that is negative or not finite.
LandmarkPatch make_patch(const TriangleMesh& mesh, const IndexLists& triangles_of_vertex,
                         const Eigen::VectorXd& vertex_areas, const Landmark& landmark, Loads loads = Loads::linear);

}  // namespace skinbem
