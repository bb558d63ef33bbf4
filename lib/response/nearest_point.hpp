// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The point of a mesh nearest to a given one.
#pragma once

#include <skinbem/mesh/triangle_mesh.hpp>

namespace skinbem {

/// A point on a mesh.
struct SurfacePoint {
  Index triangle = 0;
  Vec3 barycentric = Vec3::Zero();  ///< of the triangle's corners; not negative, sum 1
  Vec3 position = Vec3::Zero();
};

/// The point of `mesh` (at least one triangle) nearest to `point`; of several, that in the first triangle.
SurfacePoint nearest_point(const TriangleMesh& mesh, const Vec3& point);

}  // namespace skinbem
