// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Normals at the vertices.
#pragma once

#include <skinbem/mesh/triangle_mesh.hpp>

namespace skinbem {

/// Area-weighted unit vertex normals, #V by 3; the z axis where the triangles around a vertex cancel or there are none.
Points vertex_normals(const TriangleMesh& mesh);
/// Derivative of vertex_normals along the displacement field `direction` (#V by 3).
Points vertex_normal_change(const TriangleMesh& mesh, const Eigen::Ref<const Points>& direction);

}  // namespace skinbem
