// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// LU factorisation of a dense matrix stored by rows.
#pragma once

#include <algorithm>
#include <vector>

#include <skinbem/base/lapack.hpp>
#include <skinbem/solve/row_product.hpp>

namespace skinbem {

/// LU with partial pivoting, T float or double. LAPACK factorises what it sees as the transpose, M^T = P L U, so that
/// M = U^T L^T P^T: U^T and L^T lie in the triangles of M by rows, and both substitutions are products of rows.
template <class T>
class Lu {
 public:
  /// Throws Error(numerical) when a pivot is exactly zero.
  explicit Lu(Rows<T> M) : factors_(std::move(M)), pivots_(static_cast<std::size_t>(factors_.rows())) {
    const int n = static_cast<int>(factors_.rows());
    if (lapack::getrf(&n, factors_.data(), pivots_.data()) != 0) {
      throw Error(ErrorCode::numerical, "the boundary element matrix is singular; check the mesh and Poisson's ratio");
    }
    for (Eigen::Index first = 0; first < n; first += block) {
      const Eigen::Index size = std::min(block, n - first);
      const auto diagonal = factors_.block(first, first, size, size);
      const Rows<T> one = Rows<T>::Identity(size, size);
      lower_.push_back(diagonal.template triangularView<Eigen::Lower>().solve(one));
      upper_.push_back(diagonal.template triangularView<Eigen::UnitUpper>().solve(one));
    }
  }

  /// M^-1 B; with at most few_columns the same bits for any number of threads.
  Columns<T> solve(Columns<T> B) const {
    const int n = static_cast<int>(factors_.rows()), columns = static_cast<int>(B.cols());
    if (columns > few_columns) {
      lapack::getrs(&n, &columns, factors_.data(), pivots_.data(), B.data());
      return B;
    }
#pragma omp parallel for if (columns > together)
    for (Eigen::Index first = 0; first < columns; first += together) {
      substitute(B.middleCols(first, std::min(together, columns - first)));
    }
    return B;
  }

 private:
  static constexpr Eigen::Index block = 32;    ///< rows whose diagonal block is inverted: substitution without waiting
  static constexpr Eigen::Index together = 9;  ///< columns for which a thread reads the factors once

  void substitute(Eigen::Ref<Columns<T>> X) const {
    const Eigen::Index n = X.rows(), blocks = static_cast<Eigen::Index>(lower_.size());
    for (Eigen::Index b = 0; b < blocks; ++b) eliminate(lower_[b], b * block, 0, b * block, X);
    for (Eigen::Index b = blocks; b-- > 0;) {
      const Eigen::Index done = std::min(n, (b + 1) * block);
      eliminate(upper_[b], b * block, done, n - done, X);
    }
    for (Eigen::Index i = n; i-- > 0;) X.row(i).swap(X.row(pivots_[i] - 1));
  }

  /// The rows of a block from `row` on: `inverse` of (X - the factors' columns [first, first + count) times X there).
  void eliminate(const Rows<T>& inverse, Eigen::Index row, Eigen::Index first, Eigen::Index count,
                 Eigen::Ref<Columns<T>> X) const {
    auto x = X.middleRows(row, inverse.rows());
    add_row_product<T>(-1, factors_.block(row, first, x.rows(), count), X.middleRows(first, count), x);
    const Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic, 0, block, few_columns> right_side = x;
    x.setZero();
    add_row_product<T>(1, inverse, right_side, x);
  }

  Rows<T> factors_;
  std::vector<int> pivots_;
  std::vector<Rows<T>> lower_, upper_;  ///< inverses of the diagonal blocks of U^T and of L^T
};

}  // namespace skinbem
