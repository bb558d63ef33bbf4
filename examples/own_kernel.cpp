// SPDX-License-Identifier: BSD-3-Clause
// A kernel of your own (pseudo_traction.hpp) in the library's collocation: H of an octahedron, and whether it solves
// for a linear displacement.
#include <skinbem/operator/collocation_impl.hpp>

#include <cstdio>

#include "pseudo_traction.hpp"

/// An octahedron.
skinbem::TriangleMesh octahedron() {
  skinbem::TriangleMesh mesh;
  mesh.vertices = skinbem::Points{{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, -1, 0}, {0, 0, 1}, {0, 0, -1}};
  mesh.triangles =
      skinbem::Triangles{{0, 2, 4}, {2, 1, 4}, {1, 3, 4}, {3, 0, 4}, {2, 0, 5}, {1, 2, 5}, {3, 1, 5}, {0, 3, 5}};
  return mesh;
}

/// Columns of G for the traction t = D n, D constant, one triangle at a time: t jumps at edges, N t does not.
Eigen::VectorXd single_layer_of(const skinbem::TriangleMesh& mesh, const PseudoTraction& kernel,
                                const skinbem::Mat3& D) {
  const skinbem::ElementIntegral<PseudoTraction> integral(kernel, 1e-12);
  Eigen::VectorXd result = Eigen::VectorXd::Zero(3 * mesh.vertex_count());
  for (skinbem::Index t = 0; t < mesh.triangle_count(); ++t) {
    const skinbem::SourceTriangle triangle(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
    for (skinbem::Index k = 0; k < mesh.vertex_count(); ++k) {
      const auto U = integral.single_layer(triangle, mesh.vertices.row(k).transpose());
      result.segment<3>(3 * k) += (U[0] + U[1] + U[2]) * (D * triangle.geometry.normal);
    }
  }
  return result;
}

int main() {
  const PseudoTraction kernel{{.poisson = 0.3}};
  const skinbem::TriangleMesh mesh = octahedron();
  const auto H = skinbem::Collocation<PseudoTraction>(mesh, kernel, {.tolerance = 1e-12}).double_layer_matrix();

  // A linear displacement u = F x is reproduced: H u = G t with the pseudo-traction
  // t = (mu + a) F n + (lambda + mu - a) tr(F) n + a n x curl u, where a = mu (lambda + mu) / (lambda + 3 mu).
  const skinbem::Mat3 F = (skinbem::Mat3() << 0.3, 0.1, -0.4, 0.7, -0.2, 0.5, 0.2, 0.6, 0.1).finished();
  const double mu = 1, lambda = 2 * mu * kernel.poisson / (1 - 2 * kernel.poisson);
  const double a = mu * (lambda + mu) / (lambda + 3 * mu);
  const skinbem::Mat3 D =
      (mu + a) * F + (lambda + mu - a) * F.trace() * skinbem::Mat3::Identity() + a * (F.transpose() - F);

  Eigen::VectorXd u(3 * mesh.vertex_count());
  for (skinbem::Index k = 0; k < mesh.vertex_count(); ++k) u.segment<3>(3 * k) = F * mesh.vertices.row(k).transpose();
  const double residual = (H * u - single_layer_of(mesh, kernel, D)).norm() / u.norm();
  std::printf("|H u - G t| / |u| = %.1e\n", residual);
  return residual < 1e-11 ? 0 : 1;
}
