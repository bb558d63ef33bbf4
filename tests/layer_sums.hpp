// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Layer potentials of densities that the library does not assemble: discontinuous from triangle to triangle.
#pragma once

#include <skinbem/mesh/triangle_mesh.hpp>
#include <skinbem/operator/element_integral.hpp>

namespace skinbem::testing_support {

/// int U t dS at every vertex: components N. The density is linear on each triangle and given by its values at the
/// triangle's corners, `value(triangle, corner)`, a vector of `components`.
template <class Kernel, class Value>
Eigen::VectorXd single_layer_at_vertices(const TriangleMesh& mesh, const Kernel& kernel, const Value& value,
                                         double tolerance = 1e-13) {
  const ElementIntegral<Kernel> integral(kernel, tolerance);
  constexpr int n = Kernel::components;
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(n * mesh.vertex_count());
#pragma omp parallel for schedule(dynamic, 8)
  for (Index k = 0; k < mesh.vertex_count(); ++k) {
    for (Index t = 0; t < mesh.triangle_count(); ++t) {
      const SourceTriangle source(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
      const auto blocks = integral.single_layer(source, mesh.vertices.row(k).transpose());
      for (int c = 0; c < 3; ++c) sum.segment<n>(n * k) += blocks[c] * value(t, c);
    }
  }
  return sum;
}

/// Outward unit normal of a triangle.
inline Vec3 unit_normal(const TriangleMesh& mesh, Index t) { return area_vector(mesh, t).normalized(); }

/// u(x) at every vertex, node-major.
template <class Field>
Eigen::VectorXd at_vertices(const TriangleMesh& mesh, const Field& u) {
  Eigen::VectorXd values(3 * mesh.vertex_count());
  for (Index k = 0; k < mesh.vertex_count(); ++k) values.segment<3>(3 * k) = u(Vec3(mesh.vertices.row(k)));
  return values;
}

}  // namespace skinbem::testing_support
