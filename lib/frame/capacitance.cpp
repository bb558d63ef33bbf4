// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/frame/capacitance.hpp>

#include <Eigen/LU>
#include <algorithm>

#include <skinbem/base/error.hpp>

namespace skinbem::detail {
namespace {

/// Condition of a 3 by 3 pivot beyond which half of the digits would be lost.
constexpr double kWorstPivot = 1e8;

/// Whether the pivot can be divided by; `inverse` is its inverse then.
bool invert(const Mat3& pivot, Mat3& inverse) noexcept {
  inverse = pivot.inverse();
  return pivot.norm() * inverse.norm() < kWorstPivot;  // false for NaN
}

/// Removes rows and columns [begin, begin + 3) from the leading n by n block of `matrix`.
void close_gap(Eigen::MatrixXd& matrix, Index begin, Index n) noexcept {
  for (Index from = 0, to = 0; from < n; ++from) {
    if (from >= begin && from < begin + 3) continue;
    double* source = matrix.data() + from * matrix.outerStride();
    double* target = matrix.data() + to++ * matrix.outerStride();
    if (source != target) std::copy(source, source + begin, target);
    std::copy(source + begin + 3, source + n, target + begin);
  }
}

}  // namespace

Capacitance::Capacitance(const Eigen::MatrixXd& system, Index most)
    : size_(system.rows()),
      system_(6 + 3 * most, 6 + 3 * most),
      inverse_(6 + 3 * most, 6 + 3 * most),
      left_(6 + 3 * most, 3),
      right_(6 + 3 * most, 3),
      load_(6 + 3 * most),
      residual_(6 + 3 * most) {
  this->system() = system;
  inverse() = system.fullPivLu().inverse();
  if (!inverse().allFinite()) {
    throw Error(ErrorCode::bad_input, "the handles' system is singular; are two of them at the same place?");
  }
}

bool Capacitance::append(const StripView& columns, const StripView& rows, const Mat3& corner) noexcept {
  auto E = left_.topRows(size_);
  auto F = right_.topRows(size_);
  auto r = residual_.head(size_);
  for (Index j = 0; j < 3; ++j) {
    E.col(j).noalias() = inverse() * columns.col(j);
    r = columns.col(j);
    r.noalias() -= system() * E.col(j);
    E.col(j).noalias() += inverse() * r;
    F.col(j).noalias() = inverse().transpose() * rows.col(j);
    r = rows.col(j);
    r.noalias() -= system().transpose() * F.col(j);
    F.col(j).noalias() += inverse().transpose() * r;
  }
  const Mat3 pivot = corner - Mat3(rows.transpose().lazyProduct(E));
  Mat3 T;
  if (!invert(pivot, T)) return false;

  // [A + E T F, -E T; -T F, T]
  const Index n = size_;
  system_.block(0, n, n, 3) = columns;
  system_.block(n, 0, 3, n) = rows.transpose();
  system_.block<3, 3>(n, n) = corner;
  auto ET = inverse_.block(0, n, n, 3);
  auto TF = inverse_.block(n, 0, 3, n);
  ET = -E.lazyProduct(T);
  inverse().noalias() -= ET.lazyProduct(F.transpose());
  TF = -T.lazyProduct(F.transpose());
  inverse_.block<3, 3>(n, n) = T;
  size_ += 3;
  return true;
}

bool Capacitance::remove(Index k) noexcept {
  const Index begin = 6 + 3 * k;
  Mat3 T;
  if (!invert(inverse_.block<3, 3>(begin, begin), T)) return false;
  auto E = left_.topRows(size_);
  auto F = right_.topRows(size_);
  E = inverse().middleCols(begin, 3).lazyProduct(T);
  F = inverse().middleRows(begin, 3).transpose();
  inverse().noalias() -= E.lazyProduct(F.transpose());
  close_gap(system_, begin, size_);
  close_gap(inverse_, begin, size_);
  size_ -= 3;
  return true;
}

void Capacitance::exchange(Index k, Index l) noexcept {
  for (Eigen::MatrixXd* matrix : {&system_, &inverse_}) {
    matrix->middleRows<3>(6 + 3 * k).swap(matrix->middleRows<3>(6 + 3 * l));
    matrix->middleCols<3>(6 + 3 * k).swap(matrix->middleCols<3>(6 + 3 * l));
  }
}

void Capacitance::solve(const Eigen::Ref<const Eigen::VectorXd>& displacements,
                        Eigen::Ref<Eigen::VectorXd> x) noexcept {
  auto load = load_.head(size_);
  auto r = residual_.head(size_);
  load << Eigen::Matrix<double, 6, 1>::Zero(), displacements;
  x.noalias() = inverse() * load;
  r = load;
  r.noalias() -= system() * x;
  x.noalias() += inverse() * r;
}

}  // namespace skinbem::detail
