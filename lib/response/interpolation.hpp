// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A finer skin of the same body, driven by the response of a coarser one.
///
/// The displacement on the fine skin is a field u with a gradient g at every vertex; of all such fields it is the one
/// that bends least while it carries the coarse vertices where they should go:
///
///     minimise  sum_ij w_ij ( |g_j - g_i|^2 + 12 (u_j - u_i - e_ij . (g_i + g_j)/2)^2 / |e_ij|^2 )
///             + beta sum_c ( sum_v b_cv (u_v + g_v . (X_c - x_v)) - u_c )^2
///
/// for each component of u. An edge e_ij = x_j - x_i contributes the exact bending energy of the cubic Hermite curve
/// along it; w_ij are the cotangent weights, kept positive. Coarse vertex X_c is tied to the corners v of the fine
/// triangle nearest to it, with barycentric coordinates b of the nearest point, at its own place: the gradient carries
/// the value from the skin to X_c. An affine field u = a + F x has no energy and meets every condition, so it is
/// reproduced; a fine detail between coarse vertices moves and turns with its surroundings, as it would not under a
/// surface Laplacian, whose value for an affine field is the curvature. Along the skin, not through space: toes do not
/// drag each other. The matrix is sparse, symmetric, positive definite, the same for all components and columns; it is
/// factorised once.
#pragma once

#include <memory>

#include <skinbem/base/progress.hpp>
#include <skinbem/mesh/triangle_mesh.hpp>

namespace skinbem {

/// The operator W: values at coarse vertices to values at fine vertices. W itself is never stored.
class SkinInterpolation {
 public:
  /// `coarse`: #C by 3 vertices of the coarse skin; `fine`: the fine skin of the same body, in the same unit and place.
  /// Throws Error(usage) where the library was built without CHOLMOD or there is no coarse vertex, Error(bad_input)
  /// where the skins are not of one body (a coarse vertex is further than 5 % of the diagonal from the fine skin) or
  /// the coarse vertices lie in one plane and leave u open, Error(numerical) where the factorisation fails.
  SkinInterpolation(const Points& coarse, const TriangleMesh& fine, const Progress& progress = {});
  ~SkinInterpolation();
  SkinInterpolation(SkinInterpolation&&) noexcept;
  SkinInterpolation& operator=(SkinInterpolation&&) noexcept;

  /// W applied to the columns of `response`, 3 #C by any number, rows node-major x, y, z: 3 #F by the same number. With
  /// R of the coarse skin this is R of the fine one; landmarks and columns stay what they are. Throws Error(usage) on
  /// another number of rows.
  Eigen::MatrixXd apply(const Eigen::MatrixXd& response, const Progress& progress = {}) const;

  /// Largest distance of a coarse vertex from the fine skin, unit of the mesh.
  double largest_distance() const noexcept;

 private:
  struct Factor;
  void check_reproduction(const Points& coarse, const TriangleMesh& fine) const;
  std::unique_ptr<Factor> factor_;
};

}  // namespace skinbem
