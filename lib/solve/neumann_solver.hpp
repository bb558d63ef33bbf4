// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The small interface between the equation and the ways to solve it.
#pragma once

#include <memory>
#include <string>

#include <skinbem/base/progress.hpp>
#include <skinbem/base/types.hpp>
#include <skinbem/hmatrix/compressed_matrix.hpp>
#include <skinbem/operator/recovered_curvature.hpp>

namespace skinbem {

/// How a solve ended.
struct SolveSummary {
  int iterations = 0;  ///< block iterations, or steps of refinement after a direct factorisation
  /// Largest over the columns of |(H + B B^T) y - g| / |g|: computed, or after a last step of refinement a bound (ten
  /// times what such a step was measured to leave).
  double residual = 0;
};

/// Of what linear interpolation of displacements misses; empty where that is to be missed.
using SharedCurvature = std::shared_ptr<const RecoveredCurvature>;

/// (H + B B^T)^-1: H the double layer's matrix (3N by 3N, null space the rigid motions), B their orthonormal basis
/// (rigid_modes). A second-kind operator, well conditioned for a solid body. Made with a curvature, (H + (H - C) S + B
/// B^T)^-1. Factorised or prepared by its maker, then used for any number of right-hand sides.
class NeumannSolver {
 public:
  virtual ~NeumannSolver() = default;
  /// Y (3N by #columns) with (H + B B^T) Y = G (or the curved system), to the tolerance it was made with. Throws
  /// Error(numerical) with the residual that was reached where it cannot.
  virtual Eigen::MatrixXd solve(const Eigen::MatrixXd& G, SolveSummary* summary = nullptr) const = 0;
  /// H times V, as the solver has it, without curvature.
  virtual Eigen::MatrixXd apply_H(const Eigen::MatrixXd& V) const = 0;
  /// Iterative: the residual at which a column has converged from now on. Nothing for a dense solver.
  virtual void set_residual(double) {}
  /// Compressed: right-hand sides (3N by some) that are random defects of each vertex's equations, solved for its own
  /// displacement, of size 1 and alike within a leaf of the tree as those of compression are. Their solutions tell what
  /// the defects that are left may do. Nothing for a dense solver.
  virtual Eigen::MatrixXd random_defects() const { return {}; }
  /// Compressed: for messages, how to mend a body that it cannot solve.
  virtual std::string advice() const { return {}; }
};

/// Dense: LU in single precision (half the time and memory) refined to `tolerance` with residuals in double; where that
/// does not converge, LU in double. Takes H; B is 3N by 6. Throws Error(numerical) for a singular system.
std::unique_ptr<NeumannSolver> make_dense_solver(RowMajorMatrix H, const Eigen::MatrixXd& B, double tolerance,
                                                 SharedCurvature curvature = {});

/// What the iterative solver needs to know.
struct IterativeOptions {
  CompressionOptions compression;
  double residual = 5e-4;  ///< at which a column has converged
  bool single = true;      ///< matrix in single precision

  /// For a response to `tolerance` of a mesh with so many vertices. Measured on the leg of 2,000 to 50,000 vertices: R
  /// errs by one to three times the tolerance of the compression and by a tenth of the residual.
  static IterativeOptions for_tolerance(double tolerance, Index vertices);
};

/// Iterative: block GMRES on a compressed H, preconditioned by Schwarz's method. Throws Error(numerical) with the
/// residual where it does not converge.
std::unique_ptr<NeumannSolver> make_iterative_solver(const TriangleMesh& mesh,
                                                     const Collocation<Kelvin<double>>& collocation,
                                                     const Eigen::MatrixXd& B, const IterativeOptions& options,
                                                     const Progress& progress = {}, SharedCurvature curvature = {});

}  // namespace skinbem
