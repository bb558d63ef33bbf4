// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <skinbem/base/error.hpp>
#include <skinbem/solve/solver_choice.hpp>

#include "meshes.hpp"

namespace skinbem {
namespace {

using namespace testing_support;

constexpr std::size_t kPlenty = std::size_t{1} << 50;

/// 40,002 vertices, cheap to make.
TriangleMesh large() { return box({10, 1, 1}, {1000, 10, 10}); }

TEST(SolverChoice, TakesWhatIsAskedFor) {
  const TriangleMesh mesh = cube(4);
  EXPECT_EQ(choose_solver(Solver::dense, mesh, 1e-3, 2, kPlenty).solver, Solver::dense);
  EXPECT_EQ(choose_solver(Solver::hmatrix, mesh, 1e-3, 2, kPlenty).solver, Solver::hmatrix);
}

TEST(SolverChoice, IsDenseForFewVerticesAndCompressedForMany) {
  EXPECT_EQ(choose_solver(Solver::automatic, cube(4), 1e-6, 2, kPlenty).solver, Solver::dense);
  EXPECT_EQ(choose_solver(Solver::automatic, large(), 1e-4, 2, kPlenty).solver, Solver::hmatrix);
}

TEST(SolverChoice, TakesTheSlowerOneWhereOnlyThatFits) {
  const TriangleMesh mesh = cube(16);
  const std::size_t dense = predict_solver(Solver::dense, mesh, 1e-3, 2).bytes;
  const std::size_t compressed = predict_solver(Solver::hmatrix, mesh, 1e-3, 2).bytes;
  ASSERT_LT(compressed, dense);
  EXPECT_EQ(choose_solver(Solver::automatic, mesh, 1e-3, 2, compressed).solver, Solver::hmatrix);
}

TEST(SolverChoice, NeverCompressesBelowWhatCompressionReaches) {
  EXPECT_EQ(choose_solver(Solver::automatic, large(), 1e-9, 2, kPlenty).solver, Solver::dense);
  try {
    choose_solver(Solver::hmatrix, cube(4), 1e-9, 2, kPlenty);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    EXPECT_NE(std::string(error.what()).find("1e-7"), std::string::npos) << error.what();
  }
}

TEST(SolverChoice, RefusesWhatDoesNotFitWithTheNumbers) {
  const TriangleMesh mesh = large();
  try {
    choose_solver(Solver::automatic, mesh, 1e-4, 2, 250'000'000);
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
    const std::string message = error.what();
    for (const std::string& part : {std::to_string(mesh.vertex_count()) + " vertices", std::string("dense 232."),
                                    std::string("hmatrix "), std::string("0.25 GB there are")}) {
      EXPECT_NE(message.find(part), std::string::npos) << part << " is not in: " << message;
    }
  }
}

TEST(SolverChoice, PredictsLessTimeWithMoreThreadsAndMoreForMoreDigits) {
  const TriangleMesh mesh = cube(12);
  for (const Solver solver : {Solver::dense, Solver::hmatrix}) {
    EXPECT_LT(predict_solver(solver, mesh, 1e-4, 2).seconds, predict_solver(solver, mesh, 1e-4, 1).seconds);
  }
  EXPECT_LT(predict_solver(Solver::hmatrix, mesh, 1e-3, 1).seconds,
            predict_solver(Solver::hmatrix, mesh, 1e-6, 1).seconds);
  EXPECT_LT(predict_solver(Solver::hmatrix, mesh, 1e-3, 1).bytes, predict_solver(Solver::hmatrix, mesh, 1e-6, 1).bytes);
}

TEST(SolverChoice, NamesAreTheProgramsOwn) {
  EXPECT_STREQ(name_of(Solver::automatic), "auto");
  EXPECT_STREQ(name_of(Solver::dense), "dense");
  EXPECT_STREQ(name_of(Solver::hmatrix), "hmatrix");
}

}  // namespace
}  // namespace skinbem
