// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A matrix stored by rows times some columns, at the speed at which the matrix is read.
#pragma once

#include <Eigen/Core>

namespace skinbem {

template <class T>
using Columns = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;
template <class T>
using Rows = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Up to so many columns this is faster than a BLAS, which makes a packed copy of A before it multiplies.
inline constexpr Eigen::Index few_columns = 18;

/// C += alpha A B, T float or double: A is #rows by #depth, B #depth by #columns, C #rows by #columns and apart from
/// both. On the calling thread alone: callers divide the rows or the columns, at the same places for any number of
/// threads, so that the bits are the same.
template <class T>
void add_row_product(T alpha, const Eigen::Ref<const Rows<T>>& A, const Eigen::Ref<const Columns<T>>& B,
                     Eigen::Ref<Columns<T>> C);

}  // namespace skinbem
