// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <skinbem/solve/neumann_solver.hpp>
#include <skinbem/solve/rigid_modes.hpp>

#include "meshes.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

constexpr Index kNodes = 40;

Points points() {
  std::srand(3);
  return 50 * Points::Random(kNodes, 3) + Points::Constant(kNodes, 3, 200);
}

/// Second kind: near a multiple of the identity, with the rigid modes as null space.
Eigen::MatrixXd operator_like_H(const Eigen::MatrixXd& B, double disorder) {
  std::srand(5);
  const Index n = B.rows();
  const Eigen::MatrixXd A = 0.5 * Eigen::MatrixXd::Identity(n, n) + disorder * Eigen::MatrixXd::Random(n, n);
  return A - (A * B) * B.transpose();
}

TEST(RigidModes, AreOrthonormalAndSpanTranslationsAndRotations) {
  const Points p = points();
  const Eigen::MatrixXd B = rigid_modes(p);
  EXPECT_LE((B.transpose() * B - Eigen::MatrixXd::Identity(6, 6)).cwiseAbs().maxCoeff(), tolerance::rounding);
  Eigen::VectorXd motion(3 * kNodes);
  for (Index i = 0; i < kNodes; ++i) {
    motion.segment<3>(3 * i) = Vec3(1, -2, 3) + Vec3(0.3, 0.1, -0.2).cross(Vec3(p.row(i)));
  }
  EXPECT_LE((motion - B * (B.transpose() * motion)).norm(), tolerance::rounding * 10 * motion.norm());
}

TEST(RigidModes, OfPointsOnALineAreRefused) {
  Points line(5, 3);
  for (Index i = 0; i < 5; ++i) line.row(i) = (Vec3(1, 2, 3) + double(i) * Vec3(0.5, -1, 0.25)).transpose();
  try {
    rigid_modes(line);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
  }
}

TEST(DenseSolver, EqualsEigensLuAndReportsItsResidual) {
  const Eigen::MatrixXd B = rigid_modes(points());
  const Eigen::MatrixXd H = operator_like_H(B, 0.02);
  const Eigen::MatrixXd A = H + B * B.transpose();
  Eigen::MatrixXd G = Eigen::MatrixXd::Random(3 * kNodes, 5);
  G.col(1) *= 1e-30;  // columns of any size
  G.col(2) *= 1e30;
  const Eigen::MatrixXd expected = A.partialPivLu().solve(G);
  for (const double requested : {1e-4, 1e-8, 1e-14}) {
    SolveSummary summary;
    const Eigen::MatrixXd Y = make_dense_solver(H, B, requested)->solve(G, &summary);
    const Eigen::MatrixXd residual = A * Y - G;
    const double actual = (residual.colwise().norm().array() / G.colwise().norm().array()).maxCoeff();
    EXPECT_LE(actual, summary.residual + tolerance::rounding) << requested;
    EXPECT_LE(summary.residual, std::max(requested, tolerance::rounding)) << requested;
    for (Index c = 0; c < 5; ++c) {
      const double error = (Y.col(c) - expected.col(c)).norm() / expected.col(c).norm();
      EXPECT_LE(error, std::max(100 * requested, tolerance::rounding * 100)) << requested << ' ' << c;  // condition
    }
  }
}

TEST(DenseSolver, WorksInDoubleWhereSinglePrecisionDoesNotSuffice) {
  const Eigen::MatrixXd B = rigid_modes(points());
  Eigen::MatrixXd H = operator_like_H(B, 0.02);
  H.row(0) *= 1e-12;  // condition 1e12
  const Eigen::MatrixXd G = H * Eigen::MatrixXd::Random(3 * kNodes, 2);
  SolveSummary summary;
  const Eigen::MatrixXd Y = make_dense_solver(H, B, 1e-12)->solve(G, &summary);
  EXPECT_LE(summary.residual, 1e-12);
  EXPECT_LE(((H + B * B.transpose()) * Y - G).norm(), 1e-12 * G.norm());
}

TEST(DenseSolver, AppliesHWithoutTheRigidModesThatItWasShiftedBy) {
  const Eigen::MatrixXd B = rigid_modes(points());
  const Eigen::MatrixXd H = operator_like_H(B, 0.02);
  const auto solver = make_dense_solver(H, B, 1e-10);
  const Eigen::MatrixXd V = Eigen::MatrixXd::Random(3 * kNodes, 3);
  EXPECT_LE((solver->apply_H(V) - H * V).cwiseAbs().maxCoeff(), tolerance::rounding_of_sums);
  EXPECT_LE(solver->apply_H(B).cwiseAbs().maxCoeff(), tolerance::rounding_of_sums);
}

TEST(DenseSolver, SolvesTheCurvedSystemAndStillAppliesH) {
  const TriangleMesh mesh = testing_support::torus();
  const auto curvature = std::make_shared<const RecoveredCurvature>(mesh, 0.3);
  const Eigen::MatrixXd B = rigid_modes(mesh.vertices);
  const Eigen::MatrixXd H = operator_like_H(B, 0.002);
  const auto solver = make_dense_solver(H, B, 1e-10, curvature);
  const Eigen::MatrixXd G = Eigen::MatrixXd::Random(H.rows(), 4);
  SolveSummary summary;
  const Eigen::MatrixXd Y = solver->solve(G, &summary), s = curvature->of_displacements(Y);
  const Eigen::MatrixXd left = H * (Y + s) - curvature->free_part(s) + B * (B.transpose() * Y) - G;
  EXPECT_LE((left.colwise().norm().array() / G.colwise().norm().array()).maxCoeff(),
            summary.residual + tolerance::rounding_of_sums);
  EXPECT_LE(summary.residual, 1e-10);
  EXPECT_LE(summary.iterations, 3);  // what was factorised is that system
  EXPECT_LE((solver->apply_H(Y) - H * Y).cwiseAbs().maxCoeff(), tolerance::rounding_of_sums * Y.cwiseAbs().maxCoeff());
}

ErrorCode code_of_solving(const Eigen::MatrixXd& H, const Eigen::MatrixXd& B) {
  try {
    make_dense_solver(H, B, 1e-10)->solve(Eigen::MatrixXd::Random(H.rows(), 1));
  } catch (const Error& error) {
    return error.code();
  }
  return ErrorCode{};
}

TEST(DenseSolver, SingularSystemIsANumericalError) {
  const Eigen::MatrixXd B = rigid_modes(points());
  const Index n = B.rows();
  EXPECT_EQ(code_of_solving(Eigen::MatrixXd::Zero(n, n), B), ErrorCode::numerical);

  // one more null vector, as of a cavity in an incompressible body: no pivot is exactly zero
  Eigen::MatrixXd H = operator_like_H(B, 0.02);
  Eigen::VectorXd null_vector = Eigen::VectorXd::Random(n);
  null_vector -= B * (B.transpose() * null_vector);
  null_vector.normalize();
  H -= (H * null_vector).eval() * null_vector.transpose();
  EXPECT_EQ(code_of_solving(H, B), ErrorCode::numerical);
}

TEST(DenseSolver, RefusesShapesThatDoNotFit) {
  EXPECT_THROW(make_dense_solver(Eigen::MatrixXd::Identity(9, 9), Eigen::MatrixXd::Zero(12, 6), 1e-8), Error);
}

}  // namespace
}  // namespace skinbem
