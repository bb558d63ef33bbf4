// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/mesh/triangle_mesh.hpp>

#include <Eigen/Geometry>
#include <cmath>

namespace skinbem {

Vec3 area_vector(const TriangleMesh& mesh, Index t) {
  const Vec3 v0 = mesh.corner(t, 0);
  return (mesh.corner(t, 1) - v0).cross(mesh.corner(t, 2) - v0);
}

double volume(const TriangleMesh& mesh) {
  if (mesh.vertex_count() == 0) return 0;
  const Vec3 origin = mesh.vertices.colwise().mean();
  double sum = 0;
  for (Index t = 0; t < mesh.triangle_count(); ++t) sum += area_vector(mesh, t).dot(mesh.corner(t, 0) - origin);
  return sum / 6;
}

double diagonal(const TriangleMesh& mesh) {
  if (mesh.vertex_count() == 0) return 0;
  return (mesh.vertices.colwise().maxCoeff() - mesh.vertices.colwise().minCoeff()).norm();
}

double unit_scale(const TriangleMesh& mesh) { return std::exp2(-std::ceil(std::log2(diagonal(mesh)))); }

Eigen::VectorXd vertex_areas(const TriangleMesh& mesh) {
  Eigen::VectorXd areas = Eigen::VectorXd::Zero(mesh.vertex_count());
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    const double third = area_vector(mesh, t).norm() / 6;
    for (int c = 0; c < 3; ++c) areas(mesh.triangles(t, c)) += third;
  }
  return areas;
}

}  // namespace skinbem
