// SPDX-License-Identifier: BSD-3-Clause
// The two levels of the preconditioner and the iterative solver on real matrices.
#include <gtest/gtest.h>

#include <skinbem/solve/coarse_correction.hpp>
#include <skinbem/solve/neumann_solver.hpp>
#include <skinbem/solve/rigid_modes.hpp>
#include <skinbem/solve/schwarz.hpp>

#include "meshes.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using namespace testing_support;

struct Body {
  const char* name;
  TriangleMesh (*make)();
};

/// H + B B^T of a mesh, and some loads on it.
struct Equations {
  TriangleMesh mesh;
  double poisson = 0.45;
  Collocation<Kelvin<double>> collocation{mesh, {poisson, 1.0}, {1e-6}};
  Eigen::MatrixXd B = rigid_modes(mesh.vertices);

  Eigen::MatrixXd loads(Index count) const {
    Eigen::MatrixXd G(B.rows(), 3 * count);
    for (Index k = 0; k < count; ++k) {
      const VertexWeight weight{std::int32_t(k * (mesh.vertex_count() - 1) / count), 1.0};
      G.middleCols<3>(3 * k) = collocation.single_layer_columns(std::span(&weight, 1));
    }
    return G;
  }
  IterativeOptions options(double requested) const {
    return IterativeOptions::for_tolerance(requested, mesh.vertex_count());
  }
  std::unique_ptr<NeumannSolver> solver(double requested) const {
    return make_iterative_solver(mesh, collocation, B, options(requested));
  }
  double true_residual(const Eigen::MatrixXd& Y, const Eigen::MatrixXd& G) const {
    const Eigen::MatrixXd R = collocation.double_layer_matrix() * Y + B * (B.transpose() * Y) - G;
    return R.colwise().norm().cwiseQuotient(G.colwise().norm()).maxCoeff();
  }
};

constexpr double kResidual = 2e-4;

/// The same, compressed: operators in the tree's order.
struct CompressedEquations {
  explicit CompressedEquations(TriangleMesh mesh) : equations{std::move(mesh)} {}

  Equations equations;
  CompressedMatrix<double> H{equations.mesh, equations.collocation, {1e-4}};
  SchwarzPreconditioner schwarz{equations.mesh, H, equations.B};
  VectorBlock B = H.to_tree(equations.B);
  CompressedMatrix<double>::Block work;
  BlockOperator A = [this](const VectorBlock& in, VectorBlock& out) {
    H.multiply(in, out, work);
    add_product(B, inner_products(B, in), out);
  };

  GmresSummary solve(const BlockOperator& preconditioner, Index loads) const {
    GmresSummary summary;
    block_gmres(A, preconditioner, H.to_tree(equations.loads(loads)), {kResidual}, summary);
    return summary;
  }
};

class Schwarz : public ::testing::TestWithParam<Body> {};

TEST_P(Schwarz, LowersTheNumberOfIterations) {
  const CompressedEquations compressed(GetParam().make());
  const GmresSummary without = compressed.solve([](const VectorBlock& in, VectorBlock& out) { out = in; }, 2);
  const GmresSummary with =
      compressed.solve([&](const VectorBlock& in, VectorBlock& out) { compressed.schwarz.apply(in, out); }, 2);
  EXPECT_LE(with.residual, kResidual);
  EXPECT_LE(3 * with.iterations, 2 * without.iterations) << without.iterations;
}

INSTANTIATE_TEST_SUITE_P(Bodies, Schwarz,
                         ::testing::Values(Body{"cube", [] { return cube(9); }},
                                           Body{"slab", [] { return thin_slab(16, 0.04); }},
                                           Body{"torus", [] { return torus(1, 0.4, 32, 16); }}),
                         [](const auto& body) { return body.param.name; });

/// Every vertex in one part, the first of which is the end of a limb; more parts than vertices are as many as vertices.
TEST(Coarse, PartsAreLimbs) {
  const TriangleMesh body = slender_ellipsoid(3);
  const auto parts = parts_of_skin(body, 5);
  ASSERT_EQ(parts.size(), 5u);
  std::vector<int> times(static_cast<std::size_t>(body.vertex_count()));
  for (const auto& part : parts) {
    EXPECT_GT(10 * Index(part.size()), body.vertex_count());
    for (const std::int32_t v : part) ++times[static_cast<std::size_t>(v)];
  }
  EXPECT_EQ(times, std::vector<int>(times.size(), 1));
  Index axis = 0;
  (body.vertices.colwise().maxCoeff() - body.vertices.colwise().minCoeff()).maxCoeff(&axis);
  for (const std::int32_t v : parts.front()) {  // all on one side of the middle
    EXPECT_GT(body.vertices(v, axis) * body.vertices(parts.front().front(), axis), 0) << v;
  }
  EXPECT_EQ(parts_of_skin(tetrahedron(), 9).size(), 4u);
}

TEST(Coarse, InvertsAOnRigidMotionsOfParts) {
  const CompressedEquations compressed(slender_ellipsoid(3));
  const CoarseCorrection coarse(compressed.equations.mesh, compressed.H, compressed.B, 2);
  Eigen::MatrixXd motion = Eigen::MatrixXd::Zero(compressed.equations.B.rows(), 6);  // of one half of the body
  const auto parts = parts_of_skin(compressed.equations.mesh, 2);
  for (const std::int32_t v : parts.front()) {
    motion.middleRows<3>(3 * v) = compressed.equations.B.middleRows<3>(3 * v);
  }
  const VectorBlock expected = compressed.H.to_tree(motion);
  VectorBlock load, found;
  compressed.A(expected, load);
  const double size = load.norm();
  coarse.apply(load, found);
  EXPECT_LE((found - expected).norm(), tolerance::compressed_f32 * expected.norm());
  EXPECT_LE(load.norm(), tolerance::compressed_packed * size);  // nothing is left but what 16 bits of A Z lose
}

TEST(Coarse, OneLoadOnASlenderBodyTakesFewIterations) {
  const CompressedEquations compressed(slender_ellipsoid(4));
  const CoarseCorrection coarse(compressed.equations.mesh, compressed.H, compressed.B,
                                CoarseCorrection::parts_for(compressed.equations.mesh.vertex_count()));
  const GmresSummary schwarz_alone =
      compressed.solve([&](const VectorBlock& in, VectorBlock& out) { compressed.schwarz.apply(in, out); }, 1);
  const GmresSummary both = compressed.solve(
      [&](const VectorBlock& in, VectorBlock& out) {
        VectorBlock rest = in, local;
        coarse.apply(rest, out);
        compressed.schwarz.apply(rest, local);
        out += local;
      },
      1);
  EXPECT_LE(both.residual, kResidual);
  EXPECT_LE(2 * both.iterations, schwarz_alone.iterations) << schwarz_alone.iterations;
}

class IterativeSolver : public ::testing::TestWithParam<Body> {};

TEST_P(IterativeSolver, SolvesToItsResidualAndReportsIt) {
  const Equations equations{GetParam().make()};
  const Eigen::MatrixXd G = equations.loads(4);
  for (const double requested : {1e-3, 1e-5}) {
    const double allowed = equations.options(requested).residual;
    SolveSummary summary;
    const Eigen::MatrixXd Y = equations.solver(requested)->solve(G, &summary);
    EXPECT_GT(summary.iterations, 0);
    EXPECT_LE(summary.residual, allowed);
    EXPECT_LE(equations.true_residual(Y, G), tolerance::compression_in_bending * allowed) << requested;
  }
}

INSTANTIATE_TEST_SUITE_P(Bodies, IterativeSolver,
                         ::testing::Values(Body{"tetrahedron", tetrahedron}, Body{"one_leaf", [] { return cube(2); }},
                                           Body{"two_leaves", [] { return cube(3); }},
                                           Body{"cube", [] { return cube(9); }},
                                           Body{"slab", [] { return thin_slab(16, 0.04); }},
                                           Body{"hollow", [] { return hollow_sphere(2); }}),
                         [](const auto& body) { return body.param.name; });

class IterativeSolverAtPoisson : public ::testing::TestWithParam<double> {};

TEST_P(IterativeSolverAtPoisson, Solves) {
  const Equations equations{cube(6), GetParam()};
  const Eigen::MatrixXd G = equations.loads(3);
  const Eigen::MatrixXd Y = equations.solver(1e-4)->solve(G);
  EXPECT_LE(equations.true_residual(Y, G), 2 * equations.options(1e-4).residual);
}

INSTANTIATE_TEST_SUITE_P(Poisson, IterativeSolverAtPoisson, ::testing::Values(-0.9, -0.5, 0.0, 0.49, 0.5));

TEST(CompressedSolverOf, TakesAnyNumberOfColumns) {
  const Equations equations{cube(5)};
  const auto solver = equations.solver(1e-5);
  const Eigen::MatrixXd G = equations.loads(40);  // more than a block, and than a product takes
  const Eigen::MatrixXd Y = solver->solve(G);
  ASSERT_EQ(Y.cols(), 120);
  EXPECT_LE(equations.true_residual(Y, G), 3 * equations.options(1e-5).residual);
  const Eigen::MatrixXd product = solver->apply_H(Y);
  for (const Index c : {0, 47, 48, 63, 64, 119}) {
    EXPECT_LE((product.col(c) - solver->apply_H(Y.col(c))).norm(), tolerance::compressed_f32 * Y.col(c).norm()) << c;
  }
}

TEST(CompressedSolverOf, ZeroLoadGivesZeroAndAResidual) {
  const Equations equations{cube(5)};
  Eigen::MatrixXd G = equations.loads(2);
  G.col(1).setZero();
  SolveSummary summary;
  const Eigen::MatrixXd Y = equations.solver(1e-4)->solve(G, &summary);
  EXPECT_LE(Y.col(1).norm(), tolerance::rounding_of_sums * Y.col(0).norm());
  EXPECT_LE(summary.residual, equations.options(1e-4).residual);
}

TEST(CompressedSolverOf, SolvesANeedleOrSaysWhatItReached) {
  const Equations equations{needle_box(80)};  // bending of 1:20 amplifies the rounding of single precision
  const Eigen::MatrixXd G = equations.loads(4);
  constexpr double in_bending = 100;  // grows what compression left (measured: 66)
  for (const double requested : {1e-3, 1e-5}) {
    const double allowed = equations.options(requested).residual;
    SolveSummary summary;
    try {
      const Eigen::MatrixXd Y = equations.solver(requested)->solve(G, &summary);
      EXPECT_LE(summary.residual, allowed);
      EXPECT_LE(equations.true_residual(Y, G), in_bending * allowed);
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::numerical);
      EXPECT_NE(std::string(error.what()).find("residual 0.00"), std::string::npos) << error.what();
    }
  }
}

TEST(CompressedSolverOf, SaysThatTwoBodiesAreNotOne) {
  const Equations equations{joined(icosphere(2), moved(icosphere(2), {3, 0, 0}))};
  const auto solver = equations.solver(1e-4);
  try {
    solver->solve(equations.loads(2));
    FAIL() << "solved a singular system";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::numerical);
    EXPECT_NE(std::string(error.what()).find("residual"), std::string::npos) << error.what();
  }
}

}  // namespace
}  // namespace skinbem
