// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// From a mesh and its landmarks to the response matrix R.
#pragma once

#include <memory>
#include <span>
#include <vector>

#include <skinbem/base/progress.hpp>
#include <skinbem/mesh/triangle_mesh.hpp>
#include <skinbem/response/landmark_patch.hpp>
#include <skinbem/solve/solver_choice.hpp>

namespace skinbem {

/// What displacements are between the vertices.
enum class Displacements {
  linear,  ///< on each triangle, as in Tang (2010)
  curved,  ///< as their gradients at the vertices say (RecoveredCurvature): nearer to the continuous body
};

/// What `response` needs to know beside mesh and landmarks.
struct ResponseOptions {
  /// nu in (-1, 0.5]; a body with cavities: up to 0.49. R depends on no other property of the material.
  double poisson = 0.45;
  /// Of max|R - R_d| / max|R_d|, R_d the exactly integrated collocation result with such displacements and loads;
  /// 1e-12 to 1e-1.
  double tolerance = 1e-6;
  Solver solver = Solver::automatic;
  std::size_t memory_limit = 0;  ///< bytes; 0: what the system has available
  Progress progress = {};
  Displacements displacements = Displacements::linear;
  Loads loads = Loads::linear;

  /// Throws Error(usage) naming the value that is out of its range.
  void validate() const;
};

/// How it went. Times in seconds.
struct ResponseSummary {
  SolverPrediction prediction;  ///< which solver was taken, and what it was expected to take
  double assemble_seconds = 0;
  double factor_seconds = 0;
  double solve_seconds = 0;
  double near_share = 0;  ///< of vertex-triangle pairs, integrated in closed form; dense only
  /// Of R, relative to its largest entry. Dense: the smaller of the quadrature tolerance and what rotations show of its
  /// error, plus the residual. Compressed: what the H that was not compressed leaves of R's equations at some vertices
  /// (CompressionDefects), times the largest displacement that random defects of that size cause where the landmarks
  /// are held; 0 while there are too few landmarks for an R.
  double estimated_error = 0;
  double residual = 0;   ///< largest of the solves so far
  int iterations = 0;    ///< most of the solves so far
  int compressions = 0;  ///< how often H was compressed: more than once where the first did not serve; 0 for dense
};

/// A landmark and its Green's functions: displacements for unit tractions, each column of G_k scaled by 1 / load.
struct GreensFunctions {
  Landmark landmark;
  LandmarkPatch patch;
  double load = 0;         ///< Frobenius norm of G_k before scaling
  Eigen::MatrixXd X;       ///< X_k, 3N by 3, rows node-major
  Eigen::MatrixXd L;       ///< L_k, 6 by 3: what the loads lack to be in equilibrium
  Eigen::MatrixXd defect;  ///< of the equations of some vertices (CompressionDefects); nothing for a dense solver
};

/// A body whose boundary is deformed through landmarks, and everything computed about it so far: the factorised
/// operator and each landmark's Green's functions.
///
/// For each landmark k with traction density G_k (three columns, scaled to norm 1), once:
///   Y_k = (H + B B^T)^-1 G_k,  L_k = B^T Y_k,  X_k = Y_k - B L_k,
/// and for prescribed displacements u_K, with C = m(X) and m the landmarks' measurement,
///   [ C  m(B) ] [ t ]   [ u_K ]
///   [ L   0   ] [ a ] = [  0  ],   u = X t + B a = R u_K.
/// With curved displacements H is H + (H - C) S, and G_k is G_k - (H - C) S_t t_k. L t = 0 is the discrete condition
/// that the load is in equilibrium. R reproduces rigid motions by construction. Equal to the mixed system [H_U,
/// -G_K][u_U; t_K] = -H_K u_K of Tang (2010) up to rounding and amplified |H B|.
class ResponseModel {
 public:
  /// Assembles and factorises or compresses. The mesh must bound a body (validate.hpp) and is copied. Throws Error.
  ResponseModel(const TriangleMesh& mesh, const ResponseOptions& options = {});
  ~ResponseModel();
  ResponseModel(ResponseModel&&) noexcept;
  ResponseModel& operator=(ResponseModel&&) noexcept;

  /// Appends landmarks: three right-hand sides each, all solved together. Throws Error naming a landmark that is not on
  /// the mesh, or on the vertex of another; nothing is added then. With the compressed solver, where the estimated
  /// error exceeds 1.5 tolerances (three where H is in 16 bits), the iteration goes on or, where that is not to blame,
  /// H is compressed less and everything solved again; Error(numerical) where the estimate still exceeds ten.
  void add(std::span<const Landmark> landmarks);
  /// Replaces landmark k (order and count stay). Three right-hand sides. Throws like add, changing nothing.
  void move(Index k, const Landmark& landmark);
  /// Takes landmark k out; those behind it move up. No solve.
  void remove(Index k);

  /// X_k and L_k of landmarks that need not be the model's own: three right-hand sides each, all solved together and
  /// counted in the summary; the model's landmarks stay. Throws Error naming a landmark that is not on the mesh.
  std::vector<GreensFunctions> greens_functions(std::span<const Landmark> landmarks);

  const std::vector<Landmark>& landmarks() const;
  /// Nk by 3: where the landmarks are at rest, p_k = m_k(X); a point landmark's vertex.
  Points landmark_positions() const;

  /// R, 3N by 3Nk: rows node-major, columns landmark-major, x, y, z. u = R u_K with u_K the landmarks' displacements.
  /// Throws Error(bad_input) for fewer than three landmarks, landmarks on a line, or landmarks that cannot be told
  /// apart.
  Eigen::MatrixXd response() const;
  /// 3Nk by 3Nk: the tractions t_k (at the landmark's vertex, times phi elsewhere) for unit displacements, at shear
  /// modulus 1 and the mesh's unit of length; proportional to shear modulus / length. Throws like response.
  Eigen::MatrixXd tractions() const;

  const TriangleMesh& mesh() const;
  const ResponseSummary& summary() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace skinbem
