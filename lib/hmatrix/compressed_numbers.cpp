// SPDX-License-Identifier: BSD-3-Clause
// The numbers of a CompressedMatrix: bases and near blocks.
#include <algorithm>

#include <skinbem/hmatrix/compressed_matrix.hpp>

namespace skinbem {
namespace {

/// What the columns of a block row multiply.
enum class Columns { coefficients, displacements };

/// What rounding loses of a tile's numbers in the columns of displacements. It is added to the next column of the same
/// component: neighbours move nearly alike, so that what is too much in one and too little in the next hardly shows
/// (error diffusion). Coefficients of neighbouring columns have nothing in common.
template <class T>
struct Lost {
  static constexpr Index components = 3;
  T numbers[components][kTile] = {};

  /// Where the numbers of a leaf's column k are to be added.
  T* column(Index k) { return numbers[k / Index(kPanel) % components]; }
};

/// Numbers (row, k) = value(row, k) of a block row from column `first` on; what fills up its rows is zero.
template <class T, class Value>
void fill(BlockRows<T>& schedule, std::int32_t block_row, Index first, Columns kind, Index rows, Index columns,
          const Value& value) {
  const Index height = schedule.row(block_row).out.length;
  for (Index tile = 0; tile < height; tile += Index(kTile)) {
    const Index last = std::min({height, rows, tile + Index(kTile)});
    Lost<T> lost;
    for (Index k = 0; k < columns; ++k) {
      T unrounded[kTile] = {};
      T* const numbers = kind == Columns::displacements ? lost.column(k) : unrounded;
      for (Index r = tile; r < last; ++r) numbers[r - tile] += T(value(r, k));
      schedule.set_column(block_row, tile, first + k, numbers);
    }
  }
}

}  // namespace

template <class T>
void CompressedMatrix<T>::fill_bases(const NestedBases& bases) {
  const std::int32_t count = std::int32_t(tree_.clusters().size());
#pragma omp parallel for schedule(dynamic, 1)
  for (std::int32_t c = 0; c < count; ++c) {
    if (up_[c] >= 0) {
      const Eigen::MatrixXd& Q = bases.columns[c].interpolation;
      const Columns kind = tree_.clusters()[c].is_leaf() ? Columns::displacements : Columns::coefficients;
      fill(upwards_, up_[c], 0, kind, Q.cols(), Q.rows(), [&](Index r, Index k) { return Q(k, r); });
    }
    if (down_[c] >= 0) {  // the part of the parent's row coefficients that belongs to this child
      const std::int32_t parent = tree_.clusters()[c].parent;
      const Eigen::MatrixXd& P = bases.rows[parent].interpolation;
      const Index rank = Index(bases.rows[c].skeleton.size());
      const Index begin = tree_.clusters()[parent].children[1] == c ? P.rows() - rank : 0;
      fill(downwards_, down_[c], 0, Columns::coefficients, rank, P.cols(),
           [&](Index r, Index k) { return P(begin + r, k); });
    }
    if (out_[c] >= 0 && !bases.rows[c].skeleton.empty()) {
      const Eigen::MatrixXd& P = bases.rows[c].interpolation;
      fill(downwards_, out_[c], downwards_.row(out_[c]).width - P.cols(), Columns::coefficients, P.rows(), P.cols(),
           [&](Index r, Index k) { return P(r, k); });
    }
  }
}

template <class T>
Index CompressedMatrix<T>::near_column(std::int32_t leaf, std::int32_t neighbour) const {
  Index column = 0;
  for (const std::int32_t other : partition_.near[leaf]) {
    if (other == neighbour) return column;
    column += dofs_of(tree_.clusters()[other]).length;
  }
  return -1;
}

template <class T>
void CompressedMatrix<T>::fill_near_leaf(const Collocation<Kelvin<double>>& collocation, std::int32_t leaf) {
  const Cluster& cluster = tree_.clusters()[leaf];
  const auto vertices = [&](std::int32_t begin, std::int32_t end) {
    return std::span(tree_.order()).subspan(begin, end - begin);
  };
  const auto& near = partition_.near[leaf];
  T zeros[kTile] = {};
  Lost<T> lost[ClusterTree::largest_leaf / std::int32_t(kPanel)];  // by panel of rows
  constexpr std::size_t together = 8;  // leaves at once: their triangles overlap, their entries stay in the cache
  Index first_column = 0;
  for (std::size_t first = 0; first < near.size(); first += together) {
    std::vector<std::int32_t> columns;
    std::vector<Index> place;  // of each in the block row
    for (std::size_t n = first; n < std::min(near.size(), first + together); ++n) {
      const Cluster& neighbour = tree_.clusters()[near[n]];
      for (std::int32_t k = neighbour.begin; k < neighbour.end; ++k) {
        columns.push_back(tree_.order()[k]);
        place.push_back(first_column + tree_row(k - neighbour.begin, 0, components));
      }
      const WorkRange dofs = dofs_of(neighbour);
      const bool full = neighbour.size() % std::int32_t(kPanel) == 0;
      for (Index k = full ? dofs.length : dofs.length - components * Index(kPanel); k < dofs.length; ++k) {
        for (Index r = 0; r < dofs_of(cluster).length; r += Index(kTile)) {
          downwards_.set_column(out_[leaf], r, first_column + k, zeros);
        }
      }
      first_column += dofs.length;
    }
    collocation.for_double_layer_panels(
        vertices(cluster.begin, cluster.end), columns, [&](std::size_t row, std::size_t, const T* entries) {
          for (std::size_t c = 0; c < columns.size(); ++c) {
            for (int j = 0; j < components; ++j) {
              const Index column = place[c] + j * Index(kPanel);
              T* const numbers = lost[row / kPanel].column(column);
              for (int i = 0; i < components; ++i) {
                const T* from = entries + (c * components * components + components * i + j) * kPanel;
                for (std::size_t p = 0; p < kPanel; ++p) numbers[i * kPanel + p] += from[p];
              }
              downwards_.set_column(out_[leaf], Index(row) * components, column, numbers);
            }
          }
        });
  }
}

template <class T>
void CompressedMatrix<T>::fill_near(const Collocation<Kelvin<double>>& collocation, const Progress& progress) {
  static_assert(kTile == components * kPanel);
  const std::int32_t count = std::int32_t(tree_.leaves().size());
  const std::int32_t batch = 64 + count / 16;  // between two reports
  for (std::int32_t first = 0; first < count; first += batch) {
#pragma omp parallel for schedule(dynamic, 1)
    for (std::int32_t k = first; k < std::min(count, first + batch); ++k) {
      fill_near_leaf(collocation, tree_.leaves()[k]);
    }
    report(progress, "compress", bases_share + (1 - bases_share) * std::min(1.0, double(first + batch) / count));
  }
}

template class CompressedMatrix<float>;
template class CompressedMatrix<double>;

}  // namespace skinbem
