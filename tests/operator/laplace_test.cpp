// SPDX-License-Identifier: BSD-3-Clause
// A second model through the interface that Kelvin's kernel uses.
#include <gtest/gtest.h>

#include <skinbem/kernels/panel.hpp>
#include <skinbem/operator/collocation.hpp>

#include "layer_sums.hpp"
#include "meshes.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using namespace testing_support;
using Value = Eigen::Matrix<double, 1, 1>;

TEST(LaplaceOperator, DiagonalIsTheInteriorSolidAngle) {
  const TriangleMesh mesh = cube(2);
  const Eigen::MatrixXd H = Collocation<Laplace<double>>(mesh, {}, {1e-13}).double_layer_matrix();
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    double share = 1;  // a half for each of the planes x = 0, 1, y = 0, 1, z = 0, 1 through the vertex
    for (int d = 0; d < 3; ++d) share *= mesh.vertices(v, d) == 0.5 ? 1 : 0.5;
    EXPECT_NEAR(H(v, v), share, tolerance::identity);
  }
}

TEST(LaplaceOperator, DoubleLayerOfAConstantIsMinusOneInsideAndZeroOutside) {
  const TriangleMesh mesh = square_ring();
  const ElementIntegral<Laplace<double>> integral({}, 1e-12);
  const auto constant_at = [&](const Vec3& x) {
    double sum = 0;
    for (Index t = 0; t < mesh.triangle_count(); ++t) {
      const SourceTriangle source(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2));
      for (const auto& block : integral.double_layer(source, x)) sum += block(0);
    }
    return sum;
  };
  EXPECT_NEAR(constant_at({0.5, 0.5, 0.5}), -1, tolerance::identity);
  EXPECT_NEAR(constant_at({2.9, 0.1, 0.001}), -1, tolerance::identity);
  EXPECT_NEAR(constant_at({1.5, 1.5, 0.5}), 0, tolerance::identity);  // in the hole
  EXPECT_NEAR(constant_at({3.001, 0.5, 0.5}), 0, tolerance::identity);
}

TEST(LaplaceOperator, GreensIdentityIsExactForLinearFields) {
  const Vec3 slope(0.3, -1, 2);
  for (const TriangleMesh& mesh : {cube(3), square_ring(), torus()}) {
    const Eigen::MatrixXd H = Collocation<Laplace<double>>(mesh, {}, {1e-13}).double_layer_matrix();
    const Eigen::VectorXd flux = single_layer_at_vertices(
        mesh, Laplace<double>{}, [&](Index t, int) { return Value(slope.dot(unit_normal(mesh, t))); });
    EXPECT_LE((H * (mesh.vertices * slope) - flux).cwiseAbs().maxCoeff(), tolerance::identity * 10);
  }
}

TEST(LaplaceOperator, GreensIdentityForAHarmonicFieldHoldsBetterOnFinerMeshes) {
  const Vec3 pole(1.5, 1.2, -0.8);
  const auto residual = [&](int n) {
    const TriangleMesh mesh = moved(cube(n), {-0.5, -0.5, -0.5});
    const Eigen::MatrixXd H = Collocation<Laplace<double>>(mesh, {}, {1e-10}).double_layer_matrix();
    const Eigen::VectorXd u = (mesh.vertices.rowwise() - pole.transpose()).rowwise().norm().cwiseInverse();
    const Eigen::VectorXd flux = single_layer_at_vertices(mesh, Laplace<double>{}, [&](Index t, int c) {
      const Vec3 r = mesh.corner(t, c) - pole;
      return Value(-r.dot(unit_normal(mesh, t)) / std::pow(r.norm(), 3));
    });
    return (H * u - flux).cwiseAbs().maxCoeff();
  };
  const double coarse = residual(2), fine = residual(8);
  EXPECT_LE(fine, coarse / 4);  // the largest residual is at the corners, where it falls like h at least
}

/// Laplace's equation in another unit and without a batch: what a user writes.
struct Conduction {
  using Scalar = double;
  using Vector = Eigen::Vector3d;
  using Block = Eigen::Matrix<double, 1, 1>;
  static constexpr int components = 1;
  static constexpr int single_layer_singularity = 1;
  static constexpr int double_layer_singularity = 2;
  double conductivity = 1;

  Block single_layer(const Vector& r) const { return base.single_layer(r) / conductivity; }
  Block double_layer(const Vector& r, const Vector& n) const { return base.double_layer(r, n); }
  template <class Moments>
  Block single_layer_integral(const Moments& m) const {
    return base.single_layer_integral(m) / conductivity;
  }
  template <class Moments>
  Block double_layer_integral(const Moments& m, const Vector& n) const {
    return base.double_layer_integral(m, n);
  }
  Block free_term() const { return base.free_term(); }

  Laplace<double> base{};
};

TEST(UsersKernel, GoesThroughElementIntegralsAndPanelsWithoutABatchOfItsOwn) {
  const Conduction kernel{4.0};
  const SourceTriangle triangle({0, 0, 0}, {1, 0, 0}, {0, 1, 0});
  const ElementIntegral<Conduction> mine(kernel, 1e-10);
  const ElementIntegral<Laplace<double>> laplace({}, 1e-10);
  const Vec3 near(0.3, 0.2, 0.1);
  const auto a = mine.single_layer(triangle, near);
  const auto b = laplace.single_layer(triangle, near);
  for (int v = 0; v < 3; ++v) EXPECT_DOUBLE_EQ(4 * a[v](0), b[v](0));

  PointPanel panel{};
  panel.x[3] = 2;
  const double origin = 0, weight = 0.5;
  const SourcePoints source{1, &origin, &origin, &origin, {&weight, &weight, &weight}};
  double out[kPanel] = {};
  add_single_layer(kernel, panel, 1u << 3, source, out);
  EXPECT_DOUBLE_EQ(out[3], 1.5 / (4 * 4 * pi<double>() * 2));
}

}  // namespace
}  // namespace skinbem
