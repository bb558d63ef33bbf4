// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The rival: the same body, landmarks and answer by finite elements in its volume.
#pragma once

#include <memory>
#include <span>
#include <string>

#include <skinbem/mesh/triangle_mesh.hpp>
#include <skinbem/response/landmark_patch.hpp>

namespace skinbem::bench {

struct TetrahedralFemOptions {
  double poisson = 0.45;        ///< in (-1, 0.5)
  std::string quality = "q";    ///< TetGen's switches, see tetrahedral_mesh.hpp
  Loads loads = Loads::linear;  ///< as of ResponseOptions
  /// Of the BLAS under CHOLMOD: its fronts are small, so that two take three to six times as long as one (9,666 to
  /// 38,658 vertices).
  int factor_threads = 1;
};

/// How it went. Times in seconds.
struct TetrahedralFemSummary {
  double mesh_seconds = 0, assemble_seconds = 0, factor_seconds = 0, solve_seconds = 0;
  Index nodes = 0, tetrahedra = 0;
  double factor_bytes = 0;  ///< of the Cholesky factor's entries
};

/// Isotropic linear elasticity of shear modulus 1 with linear tetrahedra, K u = f, bounded by a skin of N vertices
/// whose vertices are the first nodes. K is factorised once (CHOLMOD, supernodal), with the six degrees of freedom held
/// that determine rigid motions best: under a load in equilibrium their reactions vanish and the body is free.
///
/// Linear tetrahedra lock towards Poisson's ratio 1/2.
class TetrahedralFem {
 public:
  /// Fills, assembles and factorises. Throws Error.
  explicit TetrahedralFem(const TriangleMesh& skin, const TetrahedralFemOptions& options = {});
  ~TetrahedralFem();

  /// R, 3N by 3Nk, exactly as ResponseModel::response: the same tractions (as consistent loads) and measurements, and
  /// tractions that are in equilibrium. Throws Error like it.
  Eigen::MatrixXd response(std::span<const Landmark> landmarks);

  /// Displacements of the skin, 3N by #loads, under nodal forces on the skin, 3N by #loads, node-major. Exact up to a
  /// rigid motion for forces in equilibrium; the held degrees of freedom take what is not.
  Eigen::MatrixXd displacements(const Eigen::MatrixXd& forces);

  const TetrahedralFemSummary& summary() const;

 private:
  struct State;
  std::unique_ptr<State> state_;
};

}  // namespace skinbem::bench
