// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What a landmark is on the mesh: the density of its traction and the functional that measures its displacement.
#pragma once

#include <vector>

#include <skinbem/mesh/adjacency.hpp>
#include <skinbem/operator/collocation.hpp>
#include <skinbem/response/landmark.hpp>

namespace skinbem {

/// With phi(s) = (1 - s^2)^2 for s < 1 and d_i the distance of vertex i from the landmark's vertex, over the
/// edge-connected patch around it: traction t = sum_i phi(d_i / radius) N_i t_k, measured displacement m_k(u) = sum_i
/// w_i u_i with w_i proportional to phi(d_i / radius) a_i, a_i a third of the area around i, sum w_i = 1. A radius
/// below the shortest edge at the vertex leaves one hat function and the nodal value.
struct LandmarkPatch {
  std::vector<VertexWeight> traction;     ///< phi(d_i / radius), 1 at the landmark's vertex
  std::vector<VertexWeight> measurement;  ///< w_i

  /// m_k of a field: #V by any number of values a vertex.
  Vec3 measure(const Eigen::Ref<const Points>& field) const;
};

/// `vertex_areas` as of triangle_mesh.hpp. Throws Error(bad_input) for a vertex that is not on the mesh, Error(usage)
/// for a radius that is negative or not finite.
LandmarkPatch make_patch(const TriangleMesh& mesh, const IndexLists& neighbours, const Eigen::VectorXd& areas,
                         const Landmark& landmark);

}  // namespace skinbem
