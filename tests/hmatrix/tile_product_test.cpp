// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <skinbem/base/aligned_buffer.hpp>
#include <skinbem/base/types.hpp>
#include <skinbem/hmatrix/block_rows.hpp>
#include <skinbem/hmatrix/packed_tiles.hpp>

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

/// y = A x, z = B [y; x]: two stages of heights that are not whole tiles.
template <class T>
struct TwoStages {
  using Matrix = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;
  static constexpr Index n = 80, m = 64;
  Matrix A = Matrix::Random(m, n), B = Matrix::Random(n, n + m);
  BlockRows<T> rows;

  explicit TwoStages(bool packed) {
    rows.begin_stage();
    const std::size_t first = rows.add({{n, m}, {{0, n}}, packed});
    rows.begin_stage();
    const std::size_t second = rows.add({{n + m, n}, {{n, m}, {0, n}}, packed});
    rows.allocate();
    set(first, A);
    set(second, B);
  }
  /// Column by column, and back to what is stored.
  void set(std::size_t row, Matrix& values) {
    for (Index k = 0; k < values.cols(); ++k) {
      for (Index r = 0; r < values.rows(); r += Index(kTile)) {
        rows.set_column(row, r, k, values.col(k).data() + r);
        rows.get_column(row, r, k, values.col(k).data() + r);
      }
    }
  }
  double error() const {
    typename BlockRows<T>::Block work = BlockRows<T>::Block::Random(2 * n + m, 11);
    const Matrix x = work.topRows(n);
    rows.run(work);
    Matrix stacked(n + m, 11);
    stacked << A * x, x;
    return double((work.bottomRows(n) - B * stacked).cwiseAbs().maxCoeff() / (B * stacked).cwiseAbs().maxCoeff());
  }
};

TYPED_TEST(TileProduct, OfBlockRowsRunsStageAfterStage) {
  using T = TypeParam;
  const TwoStages<T> stages(false);
  EXPECT_LE(stages.error(), sizeof(T) == 4 ? tolerance::tile_product_f32 : tolerance::rounding_of_sums);
  EXPECT_EQ(stages.rows.bytes(), sizeof(T) * std::size_t(80 * 64 + 80 * 144));
}

/// out += A x where out is filled, out = A x where it is not, and nothing where x is not.
TYPED_TEST(TileProduct, OfBlockRowsAddsWhereThereIsSomethingToAddTo) {
  using T = TypeParam;
  using Full = typename TestFixture::Matrix;
  constexpr Index n = 64, m = 80;
  const Full A = Full::Random(m, n);
  BlockRows<T> rows;
  rows.begin_stage();
  rows.add({{n, m}, {{0, n}}, false, true});
  rows.allocate();
  for (Index k = 0; k < n; ++k) {
    for (Index r = 0; r < m; r += Index(kTile)) {
      Full column = A.col(k).segment(r, std::min(Index(kTile), m - r));
      rows.set_column(0, r, k, column.data());
    }
  }
  const typename BlockRows<T>::Block start = BlockRows<T>::Block::Random(n + m, 5);
  const Full product = A * start.topRows(n), before = start.bottomRows(m);
  const auto expect = [&](const typename BlockRows<T>::Block& work, const Full& expected, const char* what) {
    EXPECT_LE(double((work.bottomRows(m) - expected).cwiseAbs().maxCoeff()), 10 * tolerance::tile_product_f32) << what;
  };
  typename BlockRows<T>::Block work = start;
  rows.run(work);
  expect(work, before + product, "all");
  for (const bool x_filled : {false, true}) {
    for (const bool out_filled : {false, true}) {
      const WorkRange x{0, n}, out{n, m};
      FilledRanges filled(n + m);
      if (x_filled) filled.add(x);
      if (out_filled) filled.add(out);
      work = start;
      rows.run_sparse(work, filled);
      expect(work, !x_filled ? before : out_filled ? Full(before + product) : product, "sparse");
      EXPECT_EQ(filled.contains(out), x_filled || out_filled);
    }
  }
}

TEST(PackedTile, ColumnsErrByHalfAStepOfTheRootsOfTheirNumbers) {
  for (const float size : {1e-30f, 1.0f, 1e30f}) {
    for (const Index height : {16, 32, 48}) {
      const Eigen::ArrayXf values = size * Eigen::ArrayXf::Random(height).cube();
      Eigen::Array<std::int16_t, Eigen::Dynamic, 1> numbers(height);
      Eigen::ArrayXf lost = values;
      const float scale = pack_column(lost.data(), std::size_t(height), numbers.data());
      EXPECT_FLOAT_EQ(scale, std::sqrt(values.abs().maxCoeff()) / 32767);
      const Eigen::ArrayXf most = (values.abs().sqrt() + scale / 4) * scale, root = numbers.cast<float>() * scale;
      EXPECT_LE((lost.abs() / most).maxCoeff(), 1.01f);
      EXPECT_GT((lost.abs() / most).maxCoeff(), 0.5f);
      EXPECT_LE(((root * root.abs() + lost - values).abs() / most).maxCoeff(), 1e-2f);
    }
  }
}

TEST(PackedTiles, MultiplyTileByTile) {
  constexpr Index tiles = 3, width = 70, columns = 5;
  const Eigen::MatrixXf A = Eigen::MatrixXf::Random(tiles * Index(kTile), width);
  const TileProduct<float>::RowMajor rhs = TileProduct<float>::RowMajor::Random(width, columns);
  PackedTiles packed(tiles, width);
  for (Index tile = 0; tile < tiles; ++tile) {
    for (Index k = 0; k < width; ++k) {
      Eigen::VectorXf column = A.col(k).segment(tile * Index(kTile), Index(kTile));
      packed.set_column(std::size_t(tile), std::size_t(k), column.data());
    }
  }
  EXPECT_EQ(packed.bytes(), std::size_t(tiles * width) * (2 * kTile + 4));
  for (Index tile = 0; tile < tiles; ++tile) {
    TileProduct<float>::RowMajor out(Index(kTile), columns);
    packed.multiply(std::size_t(tile), rhs.data(), columns, out.data());
    const Eigen::MatrixXf expected = A.middleRows(tile * Index(kTile), Index(kTile)) * rhs;
    EXPECT_LE((out - expected).cwiseAbs().maxCoeff(), tolerance::compressed_packed * width);
  }
}

TEST(PackedTile, ZerosStayZero) {
  Eigen::VectorXf zero = Eigen::VectorXf::Zero(48);
  Eigen::Matrix<std::int16_t, Eigen::Dynamic, 1> numbers(48);
  EXPECT_TRUE(std::isfinite(pack_column(zero.data(), 48, numbers.data())));
  EXPECT_TRUE((numbers.array() == 0).all());
}

TEST(PackedTile, OfBlockRowsRunsStageAfterStage) {
  const TwoStages<float> stages(true);
  EXPECT_LE(stages.error(), tolerance::tile_product_f32);
  const std::size_t numbers = 80 * 64 + 80 * 144, scales = 2 * 80 + 2 * 144;
  EXPECT_EQ(stages.rows.bytes(), 2 * numbers + 4 * scales);
  EXPECT_EQ(TwoStages<double>(true).rows.bytes(), 8 * numbers);  // never packed
}

}  // namespace
}  // namespace skinbem
