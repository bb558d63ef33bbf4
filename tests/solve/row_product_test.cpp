// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>
#include <omp.h>

#include <Eigen/LU>
#include <skinbem/solve/lu.hpp>

#include "tolerances.hpp"

namespace skinbem {
namespace {

template <class T>
constexpr double kRounding = sizeof(T) == 4 ? tolerance::tile_product_f32 : tolerance::rounding_of_sums;

template <class T>
struct RowProduct : ::testing::Test {};

using Numbers = ::testing::Types<float, double>;
TYPED_TEST_SUITE(RowProduct, Numbers);

TYPED_TEST(RowProduct, EqualsEigensForEveryShapeWithinLargerMatrices) {
  using T = TypeParam;
  const Rows<T> A = Rows<T>::Random(40, 150);
  const Columns<T> B = Columns<T>::Random(160, 20);
  for (const Index rows : {1, 3, 7, 8, 17, 40}) {
    for (const Index depth : {0, 1, 5, 15, 16, 33, 149}) {
      for (const Index columns : {1, 2, 3, 4, 18}) {
        Columns<T> C = Columns<T>::Constant(50, 20, T(7));
        Columns<T> expected = C;
        expected.block(2, 1, rows, columns) +=
            T(-0.5) * (A.bottomRightCorner(rows, depth) * B.block(4, 2, depth, columns));
        add_row_product<T>(T(-0.5), A.bottomRightCorner(rows, depth), B.block(4, 2, depth, columns),
                           C.block(2, 1, rows, columns));
        EXPECT_LE((C - expected).cwiseAbs().maxCoeff(), kRounding<T> * std::sqrt(double(depth + 1)))
            << rows << " by " << depth << " by " << columns;
      }
    }
  }
}

TYPED_TEST(RowProduct, LuSolvesFewAndManyColumnsAlike) {
  using T = TypeParam;
  for (const Index n : {1, 31, 32, 33, 100}) {
    const Rows<T> A = Rows<T>::Random(n, n) + T(2) * Rows<T>::Identity(n, n).rowwise().reverse();  // rows change places
    const Lu<T> lu(A);
    const Columns<T> many = Columns<T>::Random(n, few_columns + 1);
    const Columns<T> solved = lu.solve(many);
    const double allowed = 1e3 * kRounding<T>;  // condition
    EXPECT_LE((A * solved - many).norm(), allowed * many.norm()) << n;
    for (const Index columns : {Index(1), Index(10), few_columns}) {
      EXPECT_LE((lu.solve(many.leftCols(columns)) - solved.leftCols(columns)).norm(), allowed * solved.norm()) << n;
    }
  }
}

TYPED_TEST(RowProduct, LuSolvesFewColumnsToTheSameBitsForAnyNumberOfThreads) {
  using T = TypeParam;
  const Lu<T> lu(Rows<T>::Random(100, 100) + T(10) * Rows<T>::Identity(100, 100));
  const Columns<T> B = Columns<T>::Random(100, few_columns);
  const int threads = omp_get_max_threads();
  Columns<T> solved[2];
  for (int k = 0; k < 2; ++k) {
    omp_set_num_threads(k + 1);
    solved[k] = lu.solve(B);
  }
  omp_set_num_threads(threads);
  EXPECT_EQ(solved[0], solved[1]);
}

}  // namespace
}  // namespace skinbem
