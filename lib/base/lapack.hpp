// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The LAPACK and BLAS routines in use, by precision.
#pragma once

#include <Eigen/Core>
#include <type_traits>
#include <vector>

#include <skinbem/base/error.hpp>
#include <skinbem/base/types.hpp>

extern "C" {
void sgetrf_(const int* m, const int* n, float* a, const int* lda, int* pivots, int* info);
void dgetrf_(const int* m, const int* n, double* a, const int* lda, int* pivots, int* info);
void sgetrs_(const char* trans, const int* n, const int* nrhs, const float* a, const int* lda, const int* pivots,
             float* b, const int* ldb, int* info);
void dgetrs_(const char* trans, const int* n, const int* nrhs, const double* a, const int* lda, const int* pivots,
             double* b, const int* ldb, int* info);
void sgemm_(const char* transa, const char* transb, const int* m, const int* n, const int* k, const float* alpha,
            const float* a, const int* lda, const float* b, const int* ldb, const float* beta, float* c,
            const int* ldc);
void dgemm_(const char* transa, const char* transb, const int* m, const int* n, const int* k, const double* alpha,
            const double* a, const int* lda, const double* b, const int* ldb, const double* beta, double* c,
            const int* ldc);
void dsyrk_(const char* uplo, const char* trans, const int* n, const int* k, const double* alpha, const double* a,
            const int* lda, const double* beta, double* c, const int* ldc);
void dgemv_(const char* trans, const int* m, const int* n, const double* alpha, const double* a, const int* lda,
            const double* x, const int* incx, const double* beta, double* y, const int* incy);
void dtrsm_(const char* side, const char* uplo, const char* trans, const char* diag, const int* m, const int* n,
            const double* alpha, const double* a, const int* lda, double* b, const int* ldb);
}

namespace skinbem::lapack {

inline int getrf(const int* n, float* a, int* pivots) {
  int info = 0;
  sgetrf_(n, n, a, n, pivots, &info);
  return info;
}
inline int getrf(const int* n, double* a, int* pivots) {
  int info = 0;
  dgetrf_(n, n, a, n, pivots, &info);
  return info;
}
inline void getrs(const int* n, const int* columns, const float* a, const int* pivots, float* b) {
  int info = 0;
  sgetrs_("T", n, columns, a, n, pivots, b, n, &info);
}
inline void getrs(const int* n, const int* columns, const double* a, const int* pivots, double* b) {
  int info = 0;
  dgetrs_("T", n, columns, a, n, pivots, b, n, &info);
}

/// B becomes A^-T B; A is destroyed. False for a singular A.
template <class Matrix>
bool solve_transposed(Matrix& A, Matrix& B) {
  const int n = static_cast<int>(A.rows()), columns = static_cast<int>(B.cols());
  std::vector<int> pivots(static_cast<std::size_t>(n));
  if (getrf(&n, A.data(), pivots.data()) != 0) return false;
  getrs(&n, &columns, A.data(), pivots.data(), B.data());
  return true;
}

/// C -= op(A) B, op(A) the transpose of A for 'T' and A itself for 'N'.
inline void subtract_product(char transposed, const Eigen::Ref<const Eigen::MatrixXf>& A,
                             const Eigen::Ref<const Eigen::MatrixXf>& B, Eigen::Ref<Eigen::MatrixXf> C) {
  const int m = static_cast<int>(C.rows()), n = static_cast<int>(C.cols()), k = static_cast<int>(B.rows());
  const int lda = static_cast<int>(A.outerStride()), ldb = static_cast<int>(B.outerStride()),
            ldc = static_cast<int>(C.outerStride());
  const float minus_one = -1, one = 1;
  if (m > 0 && n > 0 && k > 0) {
    sgemm_(&transposed, "N", &m, &n, &k, &minus_one, A.data(), &lda, B.data(), &ldb, &one, C.data(), &ldc);
  }
}

/// C += alpha A B, A stored by rows.
inline void add_product(double alpha, const RowMajorMatrix& A, const Eigen::MatrixXd& B, Eigen::MatrixXd& C) {
  const int m = static_cast<int>(A.rows()), n = static_cast<int>(B.cols()), k = static_cast<int>(A.cols());
  const double one = 1;
  dgemm_("T", "N", &m, &n, &k, &alpha, A.data(), &k, B.data(), &k, &one, C.data(), &m);
}

/// C = V^T W, all stored by rows; V and W have `rows` of them.
inline void inner_product(const double* V, const double* W, Eigen::Index rows, RowMajorMatrix& C) {
  const int p = static_cast<int>(C.rows()), q = static_cast<int>(C.cols()), k = static_cast<int>(rows);
  const double one = 1, zero = 0;
  if (p > 0 && q > 0) dgemm_("N", "T", &q, &p, &k, &one, W, &q, V, &p, &zero, C.data(), &q);
}

/// W += V S, all stored by rows; V and W have `rows` of them.
template <class T>
void add_product(const T* V, const Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>& S,
                 Eigen::Index rows, T* W) {
  const int p = static_cast<int>(S.rows()), q = static_cast<int>(S.cols()), m = static_cast<int>(rows);
  const T one = 1;
  if (p == 0 || q == 0) return;
  if constexpr (std::is_same_v<T, float>) {
    sgemm_("N", "N", &q, &m, &p, &one, S.data(), &q, V, &p, &one, W, &q);
  } else {
    dgemm_("N", "N", &q, &m, &p, &one, S.data(), &q, V, &p, &one, W, &q);
  }
}

using ConstMatrixRef = Eigen::Ref<const Eigen::MatrixXd>;

/// C += A B.
inline void add_product(const ConstMatrixRef& A, const ConstMatrixRef& B, Eigen::Ref<Eigen::MatrixXd> C) {
  const int m = static_cast<int>(A.rows()), n = static_cast<int>(B.cols()), k = static_cast<int>(A.cols());
  const int lda = static_cast<int>(A.outerStride()), ldb = static_cast<int>(B.outerStride()),
            ldc = static_cast<int>(C.outerStride());
  const double one = 1;
  dgemm_("N", "N", &m, &n, &k, &one, A.data(), &lda, B.data(), &ldb, &one, C.data(), &ldc);
}

/// C = A^T B.
inline void transposed_product(const ConstMatrixRef& A, const ConstMatrixRef& B, Eigen::Ref<Eigen::MatrixXd> C) {
  const int m = static_cast<int>(A.cols()), n = static_cast<int>(B.cols()), k = static_cast<int>(A.rows());
  const int lda = static_cast<int>(A.outerStride()), ldb = static_cast<int>(B.outerStride()),
            ldc = static_cast<int>(C.outerStride());
  const double one = 1, zero = 0;
  dgemm_("T", "N", &m, &n, &k, &one, A.data(), &lda, B.data(), &ldb, &zero, C.data(), &ldc);
}

/// The lower half of C = A^T A.
inline void gram_matrix(const ConstMatrixRef& A, Eigen::Ref<Eigen::MatrixXd> C) {
  const int n = static_cast<int>(A.cols()), k = static_cast<int>(A.rows());
  const int lda = static_cast<int>(A.outerStride()), ldc = static_cast<int>(C.outerStride());
  const double one = 1, zero = 0;
  dsyrk_("L", "T", &n, &k, &one, A.data(), &lda, &zero, C.data(), &ldc);
}

/// y -= A x, A of `rows` by `columns`, its columns `stride` apart; the numbers of x `step` apart.
inline void subtract_product(const double* A, int rows, int columns, int stride, const double* x, int step, double* y) {
  const double minus_one = -1, one = 1;
  const int unit = 1;
  if (columns > 0) dgemv_("N", &rows, &columns, &minus_one, A, &stride, x, &step, &one, y, &unit);
}

/// B L^-1, L lower triangular.
inline Eigen::MatrixXd right_solve_lower(const Eigen::MatrixXd& L, Eigen::MatrixXd B) {
  const int m = static_cast<int>(B.rows()), n = static_cast<int>(B.cols());
  const double one = 1;
  if (m > 0 && n > 0) dtrsm_("R", "L", "N", "N", &m, &n, &one, L.data(), &n, B.data(), &m);
  return B;
}

}  // namespace skinbem::lapack
