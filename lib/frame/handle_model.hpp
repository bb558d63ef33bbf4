// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The Green's functions of every vertex, so that any of them can be grabbed within a frame.
#pragma once

#include <vector>

#include <skinbem/base/aligned_buffer.hpp>
#include <skinbem/response/response_model.hpp>

namespace skinbem {

/// The Green's functions X_v, L_v of a landmark on every vertex v of a body, all of one radius, in single precision:
/// 36 N^2 bytes (13 MB for 606 vertices, 900 MB for 5,000). Immutable: any number of Handles share one.
class HandleModel {
 public:
  /// More vertices than this would take more memory than is reasonable.
  static constexpr Index kMostVertices = 6000;

  /// Solves for 3 N right-hand sides with the factorisation of `body`, whose landmarks stay as they are. `radius`: of
  /// every handle, unit of the mesh, as of Landmark. Throws Error(bad_input) for more than kMostVertices vertices,
  /// Error(usage) for a radius that is negative or not finite, and as ResponseModel::add does.
  explicit HandleModel(ResponseModel& body, double radius = 0);

  Index vertex_count() const noexcept { return rest_.rows(); }
  double radius() const noexcept { return radius_; }
  /// Where the handles are at rest, p_v = m_v(X), #V by 3: the vertices where the radius is 0.
  const Points& handle_rest() const noexcept { return handle_rest_; }
  /// Bytes of the Green's functions.
  std::size_t bytes() const noexcept { return greens_.size() * sizeof(float); }

 private:
  friend class Handles;

  void keep(const GreensFunctions& greens);
  std::size_t panels() const noexcept;
  /// Three columns of panel p for a handle on vertex v: 288 floats.
  const float* columns(Index v, std::size_t p) const noexcept;
  /// m_v of the Green's functions of a handle on `source`: a block of C.
  Mat3 measure(Index v, Index source) const noexcept;
  /// m_v(B), 3 by 6.
  Eigen::Matrix<double, 3, 6> measure_rigid(Index v) const noexcept;

  double radius_;
  Points rest_;
  Points handle_rest_;
  double largest_ = 0;                          ///< magnitude in X and B
  Eigen::MatrixXd B_;                           ///< rigid modes, 3N by 6
  Eigen::Matrix<double, 6, Eigen::Dynamic> L_;  ///< L_v side by side, 6 by 3N
  detail::AlignedVector<float> greens_;         ///< by vertex, panel, column; components of a panel apart
  std::vector<VertexWeight> measurement_;       ///< of all handles
  std::vector<std::size_t> begin_ = {0};        ///< of a vertex in measurement_; one more than vertices
};

}  // namespace skinbem
