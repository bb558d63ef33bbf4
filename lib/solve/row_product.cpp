// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/solve/row_product.hpp>

#include <utility>

// Vectors of a length unknown at compile time cannot be array elements; such machines use their fixed-length set.
#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_RVV | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#endif
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "skinbem/solve/row_product.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h comes first
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace skinbem {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Eigen::Index;

/// Rows and columns that are multiplied at once: a vector that is loaded serves several sums, as registers allow.
constexpr Index kRows = HWY_TARGET <= HWY_AVX3 ? 8 : 4;
constexpr Index kColumns = 3;

/// Rows of A, or columns of B or C, `stride` apart.
template <class T>
struct Operand {
  T* data;
  Index stride;
  T* at(Index i) const { return data + i * stride; }
};

/// C += alpha A B for kWidth columns of B and as many rows of A as there are sums for. Loops over sums are expanded
/// from index sequences: compilers keep an array in registers only where every index is a constant from the outset.
template <Index kWidth, class T, Index... kSum>
HWY_INLINE void add_block(T alpha, Operand<const T> A, Operand<const T> B, Index depth, Operand<T> C,
                          std::integer_sequence<Index, kSum...>) {
  using D = hn::CappedTag<T, 16>;
  const D d;
  const auto lanes = static_cast<Index>(hn::Lanes(d));
  hn::Vec<D> sum[] = {((void)kSum, hn::Zero(d))...};
  Index k = 0;
  for (; k + lanes <= depth; k += lanes) {
    ((sum[kSum] = hn::MulAdd(hn::LoadU(d, A.at(kSum / kWidth) + k), hn::LoadU(d, B.at(kSum % kWidth) + k), sum[kSum])),
     ...);
  }
  T total[] = {hn::GetLane(hn::SumOfLanes(d, sum[kSum]))...};
  for (; k < depth; ++k) ((total[kSum] += A.at(kSum / kWidth)[k] * B.at(kSum % kWidth)[k]), ...);
  ((C.at(kSum % kWidth)[kSum / kWidth] += alpha * total[kSum]), ...);
}

template <Index kHeight, class T>
HWY_INLINE void add_rows(T alpha, Operand<const T> A, Operand<const T> B, Index depth, Index columns, Operand<T> C) {
  const auto some = [&](auto width, Index first) HWY_ATTR {
    add_block<width>(alpha, A, {B.at(first), B.stride}, depth, {C.at(first), C.stride},
                     std::make_integer_sequence<Index, kHeight * width>());
  };
  Index first = 0;
  for (; first + kColumns <= columns; first += kColumns) some(std::integral_constant<Index, kColumns>(), first);
  for (; first < columns; ++first) some(std::integral_constant<Index, 1>(), first);
}

template <class T>
HWY_INLINE void add_product(T alpha, Operand<const T> A, Operand<const T> B, Index rows, Index depth, Index columns,
                            Operand<T> C) {
  Index row = 0;
  for (; row + kRows <= rows; row += kRows) {
    add_rows<kRows>(alpha, {A.at(row), A.stride}, B, depth, columns, {C.data + row, C.stride});
  }
  for (; row < rows; ++row) add_rows<1>(alpha, {A.at(row), A.stride}, B, depth, columns, {C.data + row, C.stride});
}

void add_product_f32(float alpha, const float* A, Index a, const float* B, Index b, Index rows, Index depth,
                     Index columns, float* C, Index c) {
  add_product<float>(alpha, {A, a}, {B, b}, rows, depth, columns, {C, c});
}

void add_product_f64(double alpha, const double* A, Index a, const double* B, Index b, Index rows, Index depth,
                     Index columns, double* C, Index c) {
  add_product<double>(alpha, {A, a}, {B, b}, rows, depth, columns, {C, c});
}

}  // namespace HWY_NAMESPACE
}  // namespace skinbem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skinbem {

HWY_EXPORT(add_product_f32);
HWY_EXPORT(add_product_f64);

template <>
void add_row_product(float alpha, const Eigen::Ref<const Rows<float>>& A, const Eigen::Ref<const Columns<float>>& B,
                     Eigen::Ref<Columns<float>> C) {
  HWY_DYNAMIC_DISPATCH(add_product_f32)
  (alpha, A.data(), A.outerStride(), B.data(), B.outerStride(), A.rows(), A.cols(), B.cols(), C.data(),
   C.outerStride());
}

template <>
void add_row_product(double alpha, const Eigen::Ref<const Rows<double>>& A, const Eigen::Ref<const Columns<double>>& B,
                     Eigen::Ref<Columns<double>> C) {
  HWY_DYNAMIC_DISPATCH(add_product_f64)
  (alpha, A.data(), A.outerStride(), B.data(), B.outerStride(), A.rows(), A.cols(), B.cols(), C.data(),
   C.outerStride());
}

}  // namespace skinbem
#endif
