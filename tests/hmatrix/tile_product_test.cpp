// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <skinbem/base/aligned_buffer.hpp>
#include <skinbem/base/types.hpp>
#include <skinbem/hmatrix/block_rows.hpp>

#include "tolerances.hpp"

namespace skinbem {
namespace {

template <class T>
struct TileProduct : ::testing::Test {
  using Matrix = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;
  using RowMajor = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

  /// A (column by column, as a tile is stored) times ranges of these lengths, which lie apart in one matrix.
  static void expect_eigens(Index height, Index columns, const std::vector<Index>& lengths) {
    Index depth = 0;
    for (const Index length : lengths) depth += length;
    const Matrix A = Matrix::Random(height, depth);
    detail::AlignedVector<T> tile(A.data(), A.data() + A.size());
    const RowMajor all = RowMajor::Random(2 * depth + Index(lengths.size()), columns);
    RowMajor stacked(depth, columns);
    std::vector<RowRange<T>> ranges;
    Index next = 0, first = 0;
    for (const Index length : lengths) {
      ranges.push_back({all.data() + first * columns, static_cast<std::size_t>(length)});
      stacked.middleRows(next, length) = all.middleRows(first, length);
      next += length;
      first += 2 * length + 1;
    }
    RowMajor out =
        RowMajor::Constant(height + 1, columns, T(7));  // what was there is replaced, what is behind it stays
    multiply_tile(tile.data(), static_cast<std::size_t>(height), std::span<const RowRange<T>>(ranges),
                  static_cast<std::size_t>(columns), out.data());
    const Eigen::MatrixXd expected = A.template cast<double>() * stacked.template cast<double>();
    const double error = (out.topRows(height).template cast<double>() - expected).cwiseAbs().maxCoeff();
    const double allowed = sizeof(T) == 4 ? tolerance::tile_product_f32 : tolerance::rounding_of_sums;
    EXPECT_LE(error, allowed * std::max(1.0, std::sqrt(double(depth))))
        << height << " rows, " << columns << " columns, depth " << depth;
    EXPECT_TRUE((out.row(height).array() == T(7)).all());
  }
};

using Numbers = ::testing::Types<float, double>;
TYPED_TEST_SUITE(TileProduct, Numbers);

TYPED_TEST(TileProduct, EqualsEigensForEveryHeightAndNumberOfColumns) {
  for (const Index height : {16, 32, 48}) {
    for (Index columns = 1; columns <= Index(kMostColumns); ++columns) {
      this->expect_eigens(height, columns, {48, 5, 101});
    }
  }
}

TYPED_TEST(TileProduct, EqualsEigensForRangesOfEveryLength) {
  for (Index length = 0; length < 20; ++length) this->expect_eigens(48, 18, {length, 1, length});
  for (const Index length : {95, 96, 97, 191, 192, 193, 1000}) this->expect_eigens(48, 7, {length});
  this->expect_eigens(32, 18, {});
}

TYPED_TEST(TileProduct, OfBlockRowsRunsStageAfterStage) {
  using T = TypeParam;
  // y = A x, z = B [y; x]: heights that are not whole tiles
  const Index n = 80, m = 64;
  BlockRows<T> rows;
  rows.begin_stage();
  const std::size_t first = rows.add({n, m}, {{0, n}});
  rows.begin_stage();
  const std::size_t second = rows.add({n + m, n}, {{n, m}, {0, n}});
  rows.allocate();
  using M = typename TestFixture::Matrix;
  const M A = M::Random(m, n), B = M::Random(n, n + m);
  const auto fill = [&](std::size_t row, const M& values) {
    for (Index k = 0; k < values.cols(); ++k) {
      for (Index r = 0; r < values.rows(); ++r) rows.tile_column(row, r, k)[r % Index(kTile)] = values(r, k);
    }
  };
  fill(first, A);
  fill(second, B);
  typename BlockRows<T>::Block work = BlockRows<T>::Block::Random(2 * n + m, 11);
  const M x = work.topRows(n);
  rows.run(work);
  M stacked(n + m, 11);
  stacked << A * x, x;
  const double scale = double((B * stacked).cwiseAbs().maxCoeff());
  EXPECT_LE(double((work.bottomRows(n) - B * stacked).cwiseAbs().maxCoeff()),
            (sizeof(T) == 4 ? tolerance::tile_product_f32 : tolerance::rounding_of_sums) * scale);
  EXPECT_EQ(rows.bytes(), sizeof(T) * std::size_t(m * n + n * (n + m)));
}

}  // namespace
}  // namespace skinbem
