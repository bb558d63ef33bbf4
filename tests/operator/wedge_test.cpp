// SPDX-License-Identifier: BSD-3-Clause
// The double layer of a constant at edges and corners of any angle: the diagonal blocks that come from rigid
// translation against the free term and the principal value, both computed directly.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <skinbem/operator/collocation.hpp>
#include <skinbem/quadrature/gauss_legendre.hpp>

#include "layer_sums.hpp"
#include "meshes.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using namespace testing_support;

/// A prism over a sector of `degrees`, its edge along z; vertices of the edge are 0, 1, 2 and the one in the middle has
/// nothing but the edge around it.
TriangleMesh wedge(double degrees) {
  const int steps = static_cast<int>(degrees / 60) + 1;
  MeshMaker maker;
  const auto node = [&](int layer, int i) { return 3 + layer * (steps + 1) + i; };
  for (int layer = 0; layer < 3; ++layer) maker.vertex(Vec3(0, 0, layer));
  for (int layer = 0; layer < 3; ++layer) {
    for (int i = 0; i <= steps; ++i) {
      const double angle = degrees * std::numbers::pi / 180 * i / steps;
      maker.vertex(Vec3(std::cos(angle), std::sin(angle), layer));
    }
  }
  for (int layer = 0; layer < 2; ++layer) {
    maker.quad(layer, node(layer, 0), node(layer + 1, 0), layer + 1);
    maker.quad(layer, layer + 1, node(layer + 1, steps), node(layer, steps));
    for (int i = 0; i < steps; ++i) {
      maker.quad(node(layer, i), node(layer, i + 1), node(layer + 1, i + 1), node(layer + 1, i));
    }
  }
  for (int i = 0; i < steps; ++i) {
    maker.triangle(0, node(0, i + 1), node(0, i));
    maker.triangle(2, node(2, i), node(2, i + 1));
  }
  return maker.mesh();
}

/// The corner of one triangle at a vertex: unit edges e1, e2, counter-clockwise about the unit normal.
struct FanFace {
  std::int32_t first, last;  ///< the other vertices
  Vec3 e1, e2, normal;
  double l1, l2;
};

std::vector<FanFace> fan_around(const TriangleMesh& mesh, std::int32_t vertex) {
  std::vector<FanFace> unordered, fan;
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    for (int c = 0; c < 3; ++c) {
      if (mesh.triangles(t, c) != vertex) continue;
      const Vec3 a = mesh.corner(t, (c + 1) % 3) - mesh.corner(t, c),
                 b = mesh.corner(t, (c + 2) % 3) - mesh.corner(t, c);
      unordered.push_back({mesh.triangles(t, (c + 1) % 3), mesh.triangles(t, (c + 2) % 3), a.normalized(),
                           b.normalized(), a.cross(b).normalized(), a.norm(), b.norm()});
    }
  }
  fan.push_back(unordered.front());
  while (fan.size() < unordered.size()) {
    for (const FanFace& face : unordered) {
      if (face.first == fan.back().last) {
        fan.push_back(face);
        break;
      }
    }
  }
  return fan;
}

/// Interior solid angle: 2 pi less the exterior angles of the fan's edges (Gauss and Bonnet).
double solid_angle(const std::vector<FanFace>& fan) {
  double angle = 2 * std::numbers::pi;
  for (std::size_t k = 0; k < fan.size(); ++k) {
    const FanFace& face = fan[k];
    const Vec3& next = fan[(k + 1) % fan.size()].normal;
    angle -= std::atan2(-face.normal.cross(next).dot(face.e2), face.normal.dot(next));
  }
  return angle;
}

/// c_ij = Omega/(4 pi) d_ij - 1/(8 pi (1-nu)) sum over the faces of n_i ((e2 - e1) x n)_j. (Mantic, IJSS 30 (1993)
/// 2177)
Mat3 free_term(const std::vector<FanFace>& fan, double nu) {
  Mat3 sum = Mat3::Zero();
  for (const FanFace& f : fan) sum += f.normal * (f.e2 - f.e1).cross(f.normal).transpose();
  return solid_angle(fan) / (4 * std::numbers::pi) * Mat3::Identity() - sum / (8 * std::numbers::pi * (1 - nu));
}

/// Principal value of int N T over the fan, N the vertex's hat function. In each plane T = (1-2nu)/(8 pi (1-nu) r^2)
/// (e n^T - n e^T) with e = e(angle), and int N dr/r from epsilon to the opposite edge at R(angle) is
/// log(R/epsilon) - 1; the terms without R cancel around the fan.
Mat3 principal_value(const std::vector<FanFace>& fan, double nu) {
  const GaussView rule = gauss_legendre(60);
  Mat3 sum = Mat3::Zero();
  for (const FanFace& f : fan) {
    const Vec3 side = f.normal.cross(f.e1);
    const double opening = std::atan2(f.e2.dot(side), f.e2.dot(f.e1));
    const Vec3 opposite = f.l2 * f.e2 - f.l1 * f.e1;
    const Vec3 outward = opposite.cross(f.normal).normalized();
    const double distance = outward.dot(f.l1 * f.e1);
    Vec3 weighted = Vec3::Zero();
    for (int q = 0; q < rule.size(); ++q) {
      const double angle = opening * rule.nodes[q];
      const Vec3 e = std::cos(angle) * f.e1 + std::sin(angle) * side;
      weighted += opening * rule.weights[q] * std::log(distance / outward.dot(e)) * e;
    }
    sum += weighted * f.normal.transpose() - f.normal * weighted.transpose();
  }
  return (1 - 2 * nu) / (8 * std::numbers::pi * (1 - nu)) * sum;
}

TEST(Wedge, DiagonalByRigidTranslationIsTheDirectOneAtEveryAngle) {
  for (const double nu : {0.0, 0.3, 0.5}) {
    for (int degrees = 1; degrees < 360; ++degrees) {
      const TriangleMesh mesh = wedge(degrees);
      const Eigen::MatrixXd H = Collocation<Kelvin<double>>(mesh, {nu, 1.0}, {1e-13}).double_layer_matrix();
      for (std::int32_t v = 0; v < 4; ++v) {  // the sharp edge, its corners and one more
        const auto fan = fan_around(mesh, v);
        const Mat3 direct = free_term(fan, nu) + principal_value(fan, nu);
        EXPECT_LE((H.block<3, 3>(3 * v, 3 * v) - direct).cwiseAbs().maxCoeff(), tolerance::identity)
            << degrees << " degrees, vertex " << v << ", nu " << nu;
      }
      EXPECT_NEAR(solid_angle(fan_around(mesh, 1)), degrees * std::numbers::pi / 90, tolerance::rounding * 100);
    }
  }
}

TEST(Wedge, LaplaceDiagonalIsTheAngleOverAFullTurn) {
  for (const double degrees : {1., 30., 90., 179., 180., 181., 270., 359.}) {
    const Eigen::MatrixXd H = Collocation<Laplace<double>>(wedge(degrees), {}, {1e-13}).double_layer_matrix();
    EXPECT_NEAR(H(1, 1), degrees / 360, tolerance::identity) << degrees;
    EXPECT_NEAR(H(0, 0), degrees / 720, tolerance::identity) << degrees;
  }
}

}  // namespace
}  // namespace skinbem
