// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The LAPACK and BLAS routines in use, by precision.
#pragma once

#include <Eigen/Core>
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
void dgemm_(const char* transa, const char* transb, const int* m, const int* n, const int* k, const double* alpha,
            const double* a, const int* lda, const double* b, const int* ldb, const double* beta, double* c,
            const int* ldc);
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

/// LU with partial pivoting of a square matrix stored by rows (LAPACK factorises what it sees as the transpose).
template <class T>
class Lu {
 public:
  using Matrix = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;
  using RowMajor = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// Throws Error(numerical) when a pivot is exactly zero.
  explicit Lu(RowMajor A) : A_(std::move(A)), pivots_(static_cast<std::size_t>(A_.rows())) {
    const int n = static_cast<int>(A_.rows());
    if (getrf(&n, A_.data(), pivots_.data()) != 0) {
      throw Error(ErrorCode::numerical, "the boundary element matrix is singular; check the mesh and Poisson's ratio");
    }
  }
  Matrix solve(Matrix B) const {
    const int n = static_cast<int>(A_.rows()), columns = static_cast<int>(B.cols());
    getrs(&n, &columns, A_.data(), pivots_.data(), B.data());
    return B;
  }

 private:
  RowMajor A_;
  std::vector<int> pivots_;
};

/// C = alpha A B + beta C, A stored by rows.
inline void gemm(const RowMajorMatrix& A, const Eigen::MatrixXd& B, double alpha, double beta, Eigen::MatrixXd& C) {
  const int m = static_cast<int>(A.rows()), n = static_cast<int>(B.cols()), k = static_cast<int>(A.cols());
  dgemm_("T", "N", &m, &n, &k, &alpha, A.data(), &k, B.data(), &k, &beta, C.data(), &m);
}

}  // namespace skinbem::lapack
