// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>

#include <skinbem/mesh/vertex_normals.hpp>

namespace skinbem {
namespace {

/// Sum of the area vectors of the triangles around each vertex.
Points normal_sums(const TriangleMesh& mesh) {
  Points sums = Points::Zero(mesh.vertex_count(), 3);
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    const Vec3 area = area_vector(mesh, t);
    for (int c = 0; c < 3; ++c) sums.row(mesh.triangles(t, c)) += area.transpose();
  }
  return sums;
}

}  // namespace

Points vertex_normals(const TriangleMesh& mesh) {
  Points normals = normal_sums(mesh);
  for (Index v = 0; v < normals.rows(); ++v) {
    const double length = normals.row(v).norm();
    if (length > 0) {
      normals.row(v) /= length;
    } else {
      normals.row(v) << 0, 0, 1;
    }
  }
  return normals;
}

Points vertex_normal_change(const TriangleMesh& mesh, const Eigen::Ref<const Points>& direction) {
  const Points sums = normal_sums(mesh);
  Points change = Points::Zero(mesh.vertex_count(), 3);
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    const auto corner = mesh.triangles.row(t);
    const Vec3 a = mesh.corner(t, 1) - mesh.corner(t, 0), b = mesh.corner(t, 2) - mesh.corner(t, 0);
    const Vec3 da = direction.row(corner[1]) - direction.row(corner[0]);
    const Vec3 db = direction.row(corner[2]) - direction.row(corner[0]);
    const Vec3 d = da.cross(b) + a.cross(db);
    for (int c = 0; c < 3; ++c) change.row(corner[c]) += d.transpose();
  }
  // n = s / |s|, so dn = (1 - n n^T) ds / |s|.
  for (Index v = 0; v < change.rows(); ++v) {
    const double length = sums.row(v).norm();
    if (length > 0) {
      const Eigen::RowVector3d n = sums.row(v) / length;
      change.row(v) = (change.row(v) - change.row(v).dot(n) * n).eval() / length;
    } else {
      change.row(v).setZero();
    }
  }
  return change;
}

}  // namespace skinbem
