// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Closest point on a surface, and inside or outside of it.
#pragma once

#include <vector>

#include <skinbem/mesh/triangle_mesh.hpp>
#include <skinbem/mesh/triangle_tree.hpp>

namespace skinbem {

/// A point on a mesh.
struct SurfacePoint {
  Index triangle = 0;
  Vec3 barycentric = Vec3::Zero();  ///< weights of the triangle's corners: not negative, sum 1
  Vec3 position = Vec3::Zero();
  double distance = 0;  ///< from the point that was asked for
};

/// The point of triangle a, b, c closest to `p`; `triangle` is left 0.
SurfacePoint closest_point_of_triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p);

/// Answers questions about one surface through a tree of boxes: make it once, ask often, from any number of threads.
/// Keeps a copy of the mesh.
class SurfaceQuery {
 public:
  /// Throws Error(bad_input) when the mesh has no triangles. Coordinates must be finite, indices valid.
  explicit SurfaceQuery(TriangleMesh mesh);

  const TriangleMesh& mesh() const { return mesh_; }
  /// Of several equally close triangles, the one of lowest index met first in the tree's fixed order.
  SurfacePoint closest(const Vec3& p) const;
  /// How often the surface winds around `p`: 1 inside a body, 0 outside and in its cavities, fractions where it is
  /// open. Far parts of the surface count as dipoles, with an error of up to 0.03, measured on scanned meshes of 606 to
  /// 5,272 vertices (G. Barill et al., Fast Winding Numbers for Soups and Clouds, ACM TOG 37(4), 2018); near ones are
  /// exact (A. van Oosterom and J. Strackee, The Solid Angle of a Plane Triangle, IEEE TBME 30, 1983).
  double winding_number(const Vec3& p) const;
  /// Whether the winding number is closer to 1 (or more) than to 0.
  bool inside(const Vec3& p) const { return winding_number(p) > 0.5; }

 private:
  struct Dipole {
    Vec3 centre, area;  ///< area-weighted centre; sum of normals times areas
    double radius = 0;  ///< of a ball about the centre around the node's triangles
  };

  TriangleMesh mesh_;
  TriangleTree tree_;
  std::vector<Dipole> dipoles_;  // a node
};

}  // namespace skinbem
