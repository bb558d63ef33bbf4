// SPDX-License-Identifier: BSD-3-Clause
// The free term in closed form against the assembled matrix, against an integral over a sphere, and from both sides.
#include <gtest/gtest.h>

#include <cmath>
#include <numbers>
#include <skinbem/operator/collocation.hpp>
#include <skinbem/operator/free_term.hpp>
#include <skinbem/quadrature/gauss_legendre.hpp>

#include "meshes.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using namespace testing_support;

std::vector<TriangleMesh> bodies() {
  return {cube(2), tetrahedron(), l_shape(), square_ring(), torus(), needle_box(5), hollow_sphere(1)};
}

double difference(const Mat3& a, const Mat3& b) { return (a - b).cwiseAbs().maxCoeff(); }

/// At Poisson's ratio 1/2 T vanishes in a triangle's own plane: the own block of H is the free term and nothing else.
TEST(FreeTerm, IsTheOwnBlockOfAnIncompressibleBody) {
  for (const TriangleMesh& mesh : bodies()) {
    const Eigen::MatrixXd H = Collocation<Kelvin<double>>(mesh, {0.5, 1.0}, {1e-13}).double_layer_matrix();
    const std::vector<Mat3> terms = free_terms(mesh, 0.5);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      EXPECT_LE(difference(terms[std::size_t(v)], H.block<3, 3>(3 * v, 3 * v)), tolerance::rounding_of_sums) << v;
    }
  }
}

TEST(FreeTerm, IsTheKernelsIntegralOverTheSphereInsideACorner) {
  const TriangleMesh mesh = cube(2);
  Index corner = 0;
  ASSERT_EQ(mesh.vertices.rowwise().norm().minCoeff(&corner), 0);
  const GaussView rule = gauss_legendre(24);
  for (const double nu : {-0.5, 0.0, 0.3, 0.45}) {
    const Kelvin<double> kernel{nu, 1.0};
    Mat3 expected = Mat3::Zero();
    for (int i = 0; i < rule.size(); ++i) {
      for (int j = 0; j < rule.size(); ++j) {
        const double theta = std::numbers::pi / 2 * rule.nodes[i], phi = std::numbers::pi / 2 * rule.nodes[j];
        const Vec3 r(std::sin(theta) * std::cos(phi), std::sin(theta) * std::sin(phi), std::cos(theta));
        const double weight = std::pow(std::numbers::pi / 2, 2) * rule.weights[i] * rule.weights[j] * std::sin(theta);
        expected -= weight * kernel.double_layer(r, r);
      }
    }
    EXPECT_LE(difference(free_terms(mesh, nu)[std::size_t(corner)], expected), tolerance::rounding_of_sums) << nu;
  }
}

TEST(FreeTerm, IsOneHalfOnAFace) {
  const TriangleMesh mesh = cube(3);
  const std::vector<Mat3> terms = free_terms(mesh, 0.3);
  int on_faces = 0;
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    const auto x = mesh.vertices.row(v).array();
    if (((x > 0.1) && (x < 0.9)).count() != 2) continue;
    EXPECT_LE(difference(terms[std::size_t(v)], 0.5 * Mat3::Identity()), tolerance::rounding) << v;
    ++on_faces;
  }
  EXPECT_EQ(on_faces, 24);
}

TEST(FreeTerm, OfBothSidesIsOne) {
  for (const TriangleMesh& mesh : bodies()) {
    const std::vector<Mat3> inside = free_terms(mesh, 0.3), outside = free_terms(reversed(mesh), 0.3);
    for (std::size_t v = 0; v < inside.size(); ++v) {
      EXPECT_LE(difference(inside[v] + outside[v], Mat3::Identity()), tolerance::rounding) << v;
    }
  }
}

}  // namespace
}  // namespace skinbem
