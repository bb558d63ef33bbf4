// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Which solver, from what each is predicted to take.
#pragma once

#include <skinbem/solve/neumann_solver.hpp>

namespace skinbem {

/// How the equations are solved.
enum class Solver {
  automatic,  ///< the faster one that fits into memory
  dense,      ///< the dense matrix, factorised
  hmatrix,    ///< the compressed matrix, iteratively
};

/// Tolerance of a response below which H is not compressed: the nested bases' normal equations stop there.
inline constexpr double finest_compression = 1e-7;

/// The name that the program knows: `auto`, `dense`, `hmatrix`.
const char* name_of(Solver solver);

/// What a solver is expected to take for some eighteen right-hand sides, from figures measured on one machine.
struct SolverPrediction {
  Solver solver = Solver::dense;
  double seconds = 0;
  std::size_t bytes = 0;  ///< at the peak
};

/// For a response to `tolerance` of a mesh on `threads` threads; `solver` is not automatic.
SolverPrediction predict_solver(Solver solver, const TriangleMesh& mesh, double tolerance, int threads);

/// The wanted solver, or the faster of the two that fit into `memory_limit` bytes (0: the memory that the system has
/// available). Throws Error(usage) with the numbers where none fits, or where the tolerance is below what compression
/// reaches (1e-7).
SolverPrediction choose_solver(Solver wanted, const TriangleMesh& mesh, double tolerance, int threads,
                               std::size_t memory_limit);

/// Bytes that new work may use before the system swaps or kills; the largest number where it does not say.
std::size_t available_memory();

}  // namespace skinbem
