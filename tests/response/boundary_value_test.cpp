// SPDX-License-Identifier: BSD-3-Clause
// Neumann problems with known solutions: the discretisation error of linear collocation is a property of the method, so
// that a correct library reproduces its known size; with curved displacements it is smaller.
#include <gtest/gtest.h>

#include <Eigen/QR>
#include <functional>
#include <skinbem/operator/collocation.hpp>
#include <skinbem/solve/neumann_solver.hpp>
#include <skinbem/solve/rigid_modes.hpp>

#include "layer_sums.hpp"
#include "meshes.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using namespace testing_support;

/// Displacement at x; traction at x on a plane of normal n, of Poisson's ratio nu and shear modulus 1.
struct Field {
  std::function<Vec3(const Vec3& x)> displacement;
  std::function<Vec3(const Vec3& x, const Vec3& n)> traction;
};

Field constant_strain(double nu) {
  Mat3 strain;
  strain << 1, 0.5, -0.3, 0.5, -2, 0.7, -0.3, 0.7, 0.4;
  const Mat3 stress = 2 * nu / (1 - 2 * nu) * strain.trace() * Mat3::Identity() + 2 * strain;
  return {[=](const Vec3& x) { return Vec3(strain * x); },
          [=](const Vec3&, const Vec3& n) { return Vec3(stress * n); }};
}

Field point_load_outside(double nu) {
  const Kelvin<double> kernel{nu, 1.0};
  const Vec3 place(1.5, 2, -1), load(1, -2, 0.5);
  return {[=](const Vec3& x) { return Vec3(kernel.single_layer(x - place).transpose() * load); },
          [=](const Vec3& x, const Vec3& n) { return Vec3(kernel.double_layer(x - place, n).transpose() * load); }};
}

Field torsion(double) {
  return {[](const Vec3& x) { return Vec3(-x[1] * x[2], x[0] * x[2], 0); },
          [](const Vec3& x, const Vec3& n) { return Vec3(-x[1] * n[2], x[0] * n[2], x[0] * n[1] - x[1] * n[0]); }};
}

Field bending(double nu) {
  return {[=](const Vec3& x) {
            return Vec3(x[0] * x[2], -nu * x[1] * x[2], -(x[0] * x[0] + nu * (x[2] * x[2] - x[1] * x[1])) / 2);
          },
          [=](const Vec3& x, const Vec3& n) { return Vec3(2 * (1 + nu) * x[2] * n[0], 0, 0); }};
}

/// Uniform pressure on the sphere; the tractions of the true sphere, not those of the facets.
Field pressure_on_sphere(double nu) {
  return {[=](const Vec3& x) { return Vec3(-x * (1 - 2 * nu) / (2 * (1 + nu))); },
          [](const Vec3& x, const Vec3&) { return Vec3(-x); }};
}

struct Errors {
  double solution;     ///< max |v - u| / max |u|, rigid motions taken out of both
  double consistency;  ///< max |H u - G t| / max |u|
};

Eigen::VectorXd without_rigid(const Eigen::MatrixXd& B, const Eigen::VectorXd& w) {
  return w - B * (B.transpose() * w);
}

Errors solve(const TriangleMesh& mesh, const Field& field, double nu) {
  const Kelvin<double> kernel{nu, 1.0};
  const Eigen::MatrixXd H = Collocation<Kelvin<double>>(mesh, kernel, {1e-11}).double_layer_matrix();
  const Eigen::MatrixXd B = rigid_modes(mesh.vertices);
  const Eigen::VectorXd u = at_vertices(mesh, field.displacement);
  const Eigen::VectorXd load = single_layer_at_vertices(
      mesh, kernel, [&](Index t, int c) { return field.traction(mesh.corner(t, c), unit_normal(mesh, t)); }, 1e-11);
  const Eigen::VectorXd v = make_dense_solver(H, B, 1e-12)->solve(load);
  return {without_rigid(B, v - u).cwiseAbs().maxCoeff() / without_rigid(B, u).cwiseAbs().maxCoeff(),
          (H * u - load).cwiseAbs().maxCoeff() / u.cwiseAbs().maxCoeff()};
}

/// The error of the solution with curved displacements, for a field whose tractions are linear on each triangle.
double solve_curved(const TriangleMesh& mesh, const Field& field, double nu) {
  const Kelvin<double> kernel{nu, 1.0};
  const Eigen::MatrixXd B = rigid_modes(mesh.vertices);
  const auto curvature = std::make_shared<const RecoveredCurvature>(mesh, nu);
  const auto solver =
      make_dense_solver(Collocation<Kelvin<double>>(mesh, kernel, {1e-11}).double_layer_matrix(), B, 1e-12, curvature);
  const auto traction = [&](Index t, int c) { return field.traction(mesh.corner(t, c), unit_normal(mesh, t)); };
  Points mean(mesh.triangle_count(), 3);
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    mean.row(t) = (traction(t, 0) + traction(t, 1) + traction(t, 2)).transpose() / 3;
  }
  const Eigen::MatrixXd s = curvature->of_tractions(mean);
  const Eigen::MatrixXd load =
      single_layer_at_vertices(mesh, kernel, traction, 1e-11) - (solver->apply_H(s) - curvature->free_part(s));
  const Eigen::VectorXd u = at_vertices(mesh, field.displacement), v = solver->solve(load);
  return without_rigid(B, v - u).cwiseAbs().maxCoeff() / without_rigid(B, u).cwiseAbs().maxCoeff();
}

/// The cube [-1, 1]^3, n x n squares a face, cut along alternating diagonals.
TriangleMesh alternating_cube(int n) {
  MeshMaker maker;
  std::map<std::array<int, 3>, std::int32_t> nodes;
  for (int d = 0; d < 3; ++d) {
    for (const int side : {0, 1}) {
      const auto node = [&](int i, int j) {
        std::array<int, 3> p{};
        p[d] = side * n;
        p[(d + 1) % 3] = side ? i : j;
        p[(d + 2) % 3] = side ? j : i;
        const auto [place, fresh] = nodes.try_emplace(p, 0);
        if (fresh) place->second = maker.vertex(Vec3(p[0], p[1], p[2]) * 2 / n - Vec3::Ones());
        return place->second;
      };
      for (int i = 0; i < n; ++i) {
        for (int j = 0; j < n; ++j) {
          const auto a = node(i, j), b = node(i + 1, j), c = node(i + 1, j + 1), e = node(i, j + 1);
          if ((i + j + side) % 2 == 1) {
            maker.quad(a, b, c, e);
          } else {
            maker.quad(b, c, e, a);
          }
        }
      }
    }
  }
  return maker.mesh();
}

struct Case {
  const char* name;
  Field (*field)(double nu);
  double nu;
  std::array<double, 3> solution, consistency;  ///< coarse, middle, fine
};

// Measured with another solver in extended precision (80 bits).
const Case kSphere[] = {
    {"PointLoad030", point_load_outside, 0.3, {2.242e-2, 8.210e-3, 2.625e-3}, {3.043e-3, 8.005e-4, 2.949e-4}},
    {"PointLoad045", point_load_outside, 0.45, {2.312e-2, 8.795e-3, 3.025e-3}, {3.789e-3, 1.048e-3, 3.731e-4}},
    {"Torsion030", torsion, 0.3, {3.559e-2, 1.263e-2, 3.702e-3}, {6.402e-3, 2.549e-3, 7.612e-4}},
    {"Torsion045", torsion, 0.45, {2.833e-2, 1.144e-2, 3.565e-3}, {5.152e-3, 2.285e-3, 7.227e-4}},
    {"Bending030", bending, 0.3, {5.318e-2, 1.373e-2, 3.637e-3}, {1.825e-2, 5.008e-3, 1.467e-3}},
    {"Bending045", bending, 0.45, {4.157e-2, 1.258e-2, 3.569e-3}, {1.470e-2, 5.136e-3, 1.537e-3}},
    {"Pressure030", pressure_on_sphere, 0.3, {2.561e-2, 6.101e-3, 2.270e-3}, {1.461e-2, 2.647e-3, 1.128e-3}},
    {"Pressure045", pressure_on_sphere, 0.45, {1.528e-1, 3.227e-2, 7.373e-3}, {1.237e-1, 1.679e-2, 3.637e-3}},
};
const Case kCube[] = {
    {"PointLoad030", point_load_outside, 0.3, {2.132e-1, 7.677e-2, 1.707e-2}, {2.747e-2, 5.817e-3, 1.786e-3}},
    {"PointLoad045", point_load_outside, 0.45, {2.340e-1, 8.768e-2, 1.603e-2}, {2.777e-2, 6.493e-3, 2.020e-3}},
    {"Torsion030", torsion, 0.3, {8.894e-2, 1.987e-2, 4.720e-3}, {1.437e-2, 3.725e-3, 9.356e-4}},
    {"Torsion045", torsion, 0.45, {5.084e-2, 8.737e-3, 2.423e-3}, {9.271e-3, 1.879e-3, 5.058e-4}},
    {"Bending030", bending, 0.3, {9.848e-2, 3.488e-2, 1.293e-2}, {3.379e-2, 9.175e-3, 2.450e-3}},
    {"Bending045", bending, 0.45, {6.403e-2, 3.426e-2, 1.255e-2}, {2.970e-2, 8.478e-3, 2.373e-3}},
};

class OnSphere : public ::testing::TestWithParam<Case> {};
class OnCube : public ::testing::TestWithParam<Case> {};

void expect_known_errors(const Case& c, const std::array<TriangleMesh, 2>& meshes) {
  for (std::size_t k = 0; k < 2; ++k) {
    const Errors errors = solve(meshes[k], c.field(c.nu), c.nu);
    EXPECT_NEAR(errors.solution, c.solution[k], tolerance::known_error * c.solution[k]) << k;
    EXPECT_NEAR(errors.consistency, c.consistency[k], tolerance::known_error * c.consistency[k]) << k;
  }
}

TEST_P(OnSphere, DiscretisationErrorHasItsKnownSize) { expect_known_errors(GetParam(), {icosphere(1), icosphere(2)}); }
TEST_P(OnCube, DiscretisationErrorHasItsKnownSize) {
  expect_known_errors(GetParam(), {alternating_cube(2), alternating_cube(4)});
}

const auto kName = [](const auto& info) { return std::string(info.param.name); };
INSTANTIATE_TEST_SUITE_P(Fields, OnSphere, ::testing::ValuesIn(kSphere), kName);
INSTANTIATE_TEST_SUITE_P(Fields, OnCube, ::testing::ValuesIn(kCube), kName);

TEST(Convergence, IsQuadraticOnSphereAndCube) {
  const Errors sphere = solve(icosphere(3), torsion(0.3), 0.3);
  EXPECT_NEAR(sphere.solution, kSphere[2].solution[2], tolerance::known_error * kSphere[2].solution[2]);
  EXPECT_GE(std::log2(kSphere[2].solution[1] / sphere.solution), tolerance::observed_order);
  const Errors block = solve(alternating_cube(8), torsion(0.45), 0.45);
  EXPECT_NEAR(block.solution, kCube[3].solution[2], tolerance::known_error * kCube[3].solution[2]);
  EXPECT_GE(std::log2(kCube[3].solution[1] / block.solution), tolerance::observed_order);
}

TEST(ConstantStrain, IsSolvedToRoundingOnFacesAndSharpEdges) {
  for (const double nu : {0.3, 0.45}) {
    for (const TriangleMesh& mesh : {icosphere(1), alternating_cube(4), square_ring(), tetrahedron()}) {
      EXPECT_LE(solve(mesh, constant_strain(nu), nu).solution, tolerance::neumann_solve) << mesh.vertex_count();
    }
  }
}

TEST(CurvedDisplacements, AreNearerToKnownFields) {
  for (const double nu : {0.3, 0.45}) {
    for (const auto& field : {torsion, bending}) {
      const TriangleMesh sphere = icosphere(2);
      EXPECT_LE(solve_curved(sphere, field(nu), nu),
                tolerance::curved_on_sphere * solve(sphere, field(nu), nu).solution);
    }
    for (const TriangleMesh& mesh : {alternating_cube(4), alternating_cube(8)}) {
      const double linear = solve(mesh, bending(nu), nu).solution;
      EXPECT_LE(solve_curved(mesh, bending(nu), nu), tolerance::curved_at_edges * linear) << mesh.vertex_count();
    }
  }
}

/// Of a block, on whose faces the displacement is bilinear: its bows, along diagonals, take turns and cancel.
TEST(CurvedDisplacements, DoNoHarmWhereBowsCancel) {
  const TriangleMesh mesh = alternating_cube(4);
  EXPECT_LE(solve_curved(mesh, torsion(0.3), 0.3), solve(mesh, torsion(0.3), 0.3).solution);
}

TEST(CurvedDisplacements, SolveConstantStrainToRounding) {
  for (const double nu : {0.3, 0.45}) {
    for (const TriangleMesh& mesh : {icosphere(1), alternating_cube(4), square_ring(), tetrahedron()}) {
      EXPECT_LE(solve_curved(mesh, constant_strain(nu), nu), tolerance::neumann_solve) << mesh.vertex_count();
    }
  }
}

}  // namespace
}  // namespace skinbem
