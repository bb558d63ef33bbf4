// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The small system of the landmarks, updated instead of rebuilt. Internal to the floor.
#pragma once

#include <skinbem/base/types.hpp>

namespace skinbem::detail {

/// S = [0 L; m(B) C], 6 + 3K square, and its inverse: six unknowns of rigid motion first, then three for each handle in
/// their order. A handle that comes or goes borders the inverse (block inversion; James & Pai 1999 call it the
/// capacitance matrix): O(K^2), no allocation. Double precision.
class Capacitance {
 public:
  /// Three columns of S, or three rows of it transposed: 6 + 3K by 3.
  using Strip = Eigen::Matrix<double, Eigen::Dynamic, 3>;
  using StripView = Eigen::Ref<const Strip>;

  /// With room for `most` handles, and those of `system` (6 + 3K square) to begin with, inverted by LU. Throws
  /// Error(bad_input) where it is singular.
  Capacitance(const Eigen::MatrixXd& system, Index most);

  /// 6 + 3K.
  Index size() const noexcept { return size_; }

  /// Appends a handle: `columns` and transposed `rows` of S, each size() by 3, and the block where they meet. Returns
  /// false and changes nothing where the system would be singular. There must be room.
  bool append(const StripView& columns, const StripView& rows, const Mat3& corner) noexcept;
  /// Takes handle k out; those behind it move up. Returns false and changes nothing where the system would be singular.
  bool remove(Index k) noexcept;
  /// Exchanges the numbers of two handles.
  void exchange(Index k, Index l) noexcept;

  /// S x = [0; u]: `displacements` u, 3K. Refined once, so that the rounding of many updates does not remain. `x`:
  /// size() numbers.
  void solve(const Eigen::Ref<const Eigen::VectorXd>& displacements, Eigen::Ref<Eigen::VectorXd> x) noexcept;

 private:
  auto system() noexcept { return system_.topLeftCorner(size_, size_); }
  auto inverse() noexcept { return inverse_.topLeftCorner(size_, size_); }

  Index size_ = 0;
  Eigen::MatrixXd system_;   ///< S, in the leading block
  Eigen::MatrixXd inverse_;  ///< S^-1, in the leading block
  Strip left_, right_;       ///< S^-1 times the new columns; the new rows times S^-1, transposed
  Eigen::VectorXd load_, residual_;
};

}  // namespace skinbem::detail
