// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/hmatrix/compressed_matrix.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>

#include <skinbem/base/lapack.hpp>
#include <skinbem/base/stopwatch.hpp>
#include <skinbem/mesh/adjacency.hpp>

namespace skinbem {
namespace {

constexpr std::int32_t most_packed_vertices = 3 * ClusterTree::leaf_size;  ///< of a cluster

WorkRange filled_up(const WorkRange& range) { return {range.first, round_up(range.length, kTileStep)}; }

/// Its number; `bytes` grows by what it takes.
template <class T>
std::int32_t add_row(BlockRows<T>& schedule, BlockRow row, std::size_t& bytes) {
  const std::size_t number = schedule.add(std::move(row));
  bytes += BlockRows<T>::bytes(schedule.row(number));
  return std::int32_t(number);
}

}  // namespace

template <class T>
WorkRange CompressedMatrix<T>::dofs_of(const Cluster& leaf) {
  return {Index(leaf.begin) * components, round_up(leaf.size(), kPanel) * components};
}

template <class T>
CompressedMatrix<T>::CompressedMatrix(const TriangleMesh& mesh, const Collocation<Kelvin<double>>& collocation,
                                      const CompressionOptions& options, const Progress& progress)
    : tree_(mesh),
      partition_(tree_, options.eta),
      rows_(round_up(mesh.vertex_count(), kPanel) * components),
      packed_(options.packed),
      diagonal_(mesh.vertex_count(), Mat3::Zero()) {
  leaf_of_place_.resize(mesh.vertex_count());
  for (const std::int32_t leaf : tree_.leaves()) {
    std::fill(leaf_of_place_.begin() + tree_.clusters()[leaf].begin,
              leaf_of_place_.begin() + tree_.clusters()[leaf].end, leaf);
  }
  Stopwatch watch;
  report(progress, "compress", 0);
  compress_far_field(mesh, collocation, options, progress);
  detail::return_freed_memory();
  summary_.basis_seconds = watch.lap();
  fill_near(collocation, progress);
  set_diagonal();
  keep_exact_rows(mesh, collocation);
  summary_.near_seconds = watch.lap();
}

/// The bases in double take a third of what the near blocks do, and are gone before these are made.
template <class T>
void CompressedMatrix<T>::compress_far_field(const TriangleMesh& mesh, const Collocation<Kelvin<double>>& collocation,
                                             const CompressionOptions& options, const Progress& progress) {
  const PointKernel<Kelvin<double>> kernel(mesh, tree_, collocation.kernel());
  const NestedBases bases =
      make_nested_bases(mesh, tree_, partition_, collocation, kernel, {options.tolerance, options.samples},
                        [&](double fraction) { report(progress, "compress", bases_share * fraction); });
  plan(bases, kernel);
  fill_bases(bases);
}

/// Lays out workspace and schedule: vectors in, coefficients of column skeletons from the leaves up, those of row
/// skeletons from the root down, vectors out.
template <class T>
void CompressedMatrix<T>::plan(const NestedBases& bases, const PointKernel<Kelvin<double>>& kernel) {
  Index end = rows_;
  const auto reserve = [&](const std::vector<ClusterBasis>& of) {
    std::vector<WorkRange> ranges;
    for (const ClusterBasis& basis : of) {
      ranges.push_back({end, Index(basis.skeleton.size())});
      end += round_up(ranges.back().length, kTileStep);
    }
    return ranges;
  };
  const std::vector<WorkRange> columns = reserve(bases.columns), rows = reserve(bases.rows);
  work_rows_ = end + rows_;
  couplings_ = Couplings<T>(kernel, bases, partition_, rows, columns);
  plan_upwards(columns);
  plan_downwards(rows);
  plan_leaves(rows, end);
  upwards_.allocate();
  downwards_.allocate();
  summary_.coupling_bytes = couplings_.bytes();
  summary_.coupling_numbers = couplings_.numbers();

  const auto add_rank = [](double sum, const WorkRange& range) { return sum + double(range.length); };
  const auto used = [](const WorkRange& range) { return range.length > 0; };
  const double ranks = std::accumulate(rows.begin(), rows.end(), 0.0, add_rank) +
                       std::accumulate(columns.begin(), columns.end(), 0.0, add_rank);
  const auto count =
      std::count_if(rows.begin(), rows.end(), used) + std::count_if(columns.begin(), columns.end(), used);
  summary_.mean_rank = count > 0 ? ranks / double(count) : 0;
}

template <class T>
bool CompressedMatrix<T>::is_packed(const Cluster& cluster) const {
  return packed_ && cluster.size() <= most_packed_vertices;
}

/// Coefficients of the columns' skeletons, from a leaf's degrees of freedom or those of the two children.
template <class T>
void CompressedMatrix<T>::plan_upwards(const std::vector<WorkRange>& columns) {
  up_.assign(columns.size(), -1);
  for (std::size_t level = tree_.levels().size() - 1; level-- > 0;) {
    upwards_.begin_stage();
    for (std::int32_t c = tree_.levels()[level]; c < tree_.levels()[level + 1]; ++c) {
      if (columns[c].length == 0) continue;
      const Cluster& cluster = tree_.clusters()[c];
      std::vector<WorkRange> sources;
      if (cluster.is_leaf()) {
        sources.push_back(dofs_of(cluster));
      } else {
        for (const std::int32_t child : cluster.children) sources.push_back(columns[child]);
      }
      up_[c] = add_row(upwards_, {filled_up(columns[c]), std::move(sources), is_packed(cluster)}, summary_.basis_bytes);
    }
  }
}

/// What a parent adds to the coefficients of the rows' skeletons.
template <class T>
void CompressedMatrix<T>::plan_downwards(const std::vector<WorkRange>& rows) {
  down_.assign(rows.size(), -1);
  for (std::size_t level = 0; level + 1 < tree_.levels().size(); ++level) {
    downwards_.begin_stage();
    for (std::int32_t c = tree_.levels()[level]; c < tree_.levels()[level + 1]; ++c) {
      const Cluster& cluster = tree_.clusters()[c];
      if (cluster.parent < 0 || rows[cluster.parent].length == 0) continue;
      down_[c] = add_row(downwards_,
                         {filled_up(rows[c]), {rows[cluster.parent]}, is_packed(cluster), couplings_.has_partners(c)},
                         summary_.basis_bytes);
    }
  }
}

/// Vectors out, `out` rows into the workspace, from the neighbours' degrees of freedom and the leaf's coefficients.
template <class T>
void CompressedMatrix<T>::plan_leaves(const std::vector<WorkRange>& rows, Index out) {
  out_.assign(rows.size(), -1);
  downwards_.begin_stage();
  for (const std::int32_t leaf : tree_.leaves()) {
    std::vector<WorkRange> sources;
    for (const std::int32_t neighbour : partition_.near[leaf]) {
      sources.push_back(dofs_of(tree_.clusters()[neighbour]));
    }
    if (rows[leaf].length > 0) sources.push_back(rows[leaf]);
    const WorkRange dofs = dofs_of(tree_.clusters()[leaf]);
    out_[leaf] =
        add_row(downwards_, {{out + dofs.first, dofs.length}, std::move(sources), packed_}, summary_.near_bytes);
  }
}

/// Rigid translation: minus the sum of a row's other blocks.
template <class T>
void CompressedMatrix<T>::set_diagonal() {
  Eigen::MatrixXd ones(components * Index(tree_.order().size()), components);
  for (Index k = 0; k < ones.rows(); ++k) ones.row(k) = Eigen::RowVector3d::Unit(k % components);
  VectorBlock sums;
  Block work;
  multiply(to_tree(ones), sums, work);
  for (std::size_t place = 0; place < diagonal_.size(); ++place) {
    for (int i = 0; i < components; ++i) diagonal_[place].row(i) = -sums.row(tree_row(Index(place), i, components));
  }
}

/// Of the worst of the vertices whose own block is close to singular, and of their neighbours, whose errors they see.
template <class T>
void CompressedMatrix<T>::keep_exact_rows(const TriangleMesh& mesh, const Collocation<Kelvin<double>>& collocation) {
  const auto found = close_to_singular(diagonal_.size(), [&](std::size_t place) { return diagonal_[place]; });
  if (found.empty()) return;
  const IndexLists neighbours = neighbours_of_vertices(mesh);
  std::vector<bool> wanted(mesh.vertex_count());
  for (const std::size_t place : found) {
    const std::int32_t vertex = tree_.order()[place];
    wanted[vertex] = true;
    for (const std::int32_t neighbour : neighbours[vertex]) wanted[neighbour] = true;
  }
  std::vector<std::int32_t> vertices;
  for (std::int32_t place = 0; place < std::int32_t(diagonal_.size()); ++place) {
    if (!wanted[tree_.order()[place]]) continue;
    exact_places_.push_back(place);
    vertices.push_back(tree_.order()[place]);
  }
  const ExactRows exact(collocation, std::move(vertices));
  exact_rows_ = to_tree(exact.rows().transpose()).transpose();
  for (std::size_t k = 0; k < exact_places_.size(); ++k) diagonal_[exact_places_[k]] = exact.own_block(k);
  summary_.exact_vertices = Index(exact_places_.size());
}

template <class T>
VectorBlock CompressedMatrix<T>::to_tree(const Eigen::MatrixXd& vectors) const {
  const std::vector<std::int32_t>& order = tree_.order();
  const std::int32_t places = std::int32_t(order.size()), panel = std::int32_t(kPanel);
  VectorBlock result(rows_, vectors.cols());
#pragma omp parallel for schedule(static)
  for (std::int32_t first = 0; first < places; first += panel) {
    if (first + panel > places) result.bottomRows(components * Index(kPanel)).setZero();
    for (std::int32_t place = first; place < std::min(places, first + panel); ++place) {
      for (int i = 0; i < components; ++i) {
        result.row(tree_row(place, i, components)) = vectors.row(Index(order[place]) * components + i);
      }
    }
  }
  return result;
}

template <class T>
Eigen::MatrixXd CompressedMatrix<T>::from_tree(const VectorBlock& vectors) const {
  const std::vector<std::int32_t>& order = tree_.order();
  Eigen::MatrixXd result(Index(order.size()) * components, vectors.cols());
#pragma omp parallel for schedule(static)
  for (std::int32_t place = 0; place < std::int32_t(order.size()); ++place) {
    for (int i = 0; i < components; ++i) {
      result.row(Index(order[place]) * components + i) = vectors.row(tree_row(place, i, components));
    }
  }
  return result;
}

template <class T>
void CompressedMatrix<T>::multiply(const VectorBlock& X, VectorBlock& Y, Block& work) const {
  if (work.rows() != work_rows_ || work.cols() != X.cols()) work.resize(work_rows_, X.cols());
  const Index panel_rows = components * Index(kPanel);
#pragma omp parallel for schedule(static)
  for (Index row = 0; row < rows_; row += panel_rows) {
    work.middleRows(row, panel_rows) = X.middleRows(row, panel_rows).template cast<T>();
  }
  upwards_.run(work);
  couplings_.run(work);
  downwards_.run(work);
  finish_product(X, work, Y);
}

template <class T>
void CompressedMatrix<T>::multiply_sparse(const VectorBlock& X, VectorBlock& Y, Block& work) const {
  if (work.rows() != work_rows_ || work.cols() != X.cols()) work.resize(work_rows_, X.cols());
  FilledRanges filled(work_rows_);
  for (const std::int32_t leaf : tree_.leaves()) {
    const WorkRange dofs = dofs_of(tree_.clusters()[leaf]);
    if ((X.middleRows(dofs.first, dofs.length).array() == 0).all()) continue;
    work.middleRows(dofs.first, dofs.length) = X.middleRows(dofs.first, dofs.length).template cast<T>();
    filled.add(dofs);
  }
  work.bottomRows(rows_).setZero();
  upwards_.run_sparse(work, filled);
  couplings_.run_sparse(work, filled);
  downwards_.run_sparse(work, filled);
  finish_product(X, work, Y);
}

template <class T>
void CompressedMatrix<T>::finish_product(const VectorBlock& X, const Block& work, VectorBlock& Y) const {
  Y.resize(rows_, X.cols());
  const Index places = Index(diagonal_.size()), panel_rows = components * Index(kPanel);
#pragma omp parallel for schedule(static)
  for (Index first = 0; first < places; first += Index(kPanel)) {
    const Index row = first * components;
    Y.middleRows(row, panel_rows) = work.middleRows(work_rows_ - rows_ + row, panel_rows).template cast<double>();
    for (Index place = first; place < std::min(places, first + Index(kPanel)); ++place) {
      for (int i = 0; i < components; ++i) {
        for (int j = 0; j < components; ++j) {
          Y.row(tree_row(place, i, components)) += diagonal_[place](i, j) * X.row(tree_row(place, j, components));
        }
      }
    }
  }
  multiply_exact_rows(X, Y);
}

template <class T>
void CompressedMatrix<T>::multiply_exact_rows(const VectorBlock& X, VectorBlock& Y) const {
  constexpr Index together = 8;  // vertices
  const Index count = Index(exact_places_.size());
#pragma omp parallel for schedule(dynamic, 1)
  for (Index first = 0; first < count; first += together) {
    const Index rows = components * std::min(together, count - first);
    RowMajorMatrix product = RowMajorMatrix::Zero(rows, X.cols());
    lapack::add_product(exact_rows_.row(components * first).data(), X, rows, product.data());
    for (Index r = 0; r < rows; ++r) {
      Y.row(tree_row(exact_places_[first + r / components], int(r % components), components)) = product.row(r);
    }
  }
}

template <class T>
Eigen::MatrixXf CompressedMatrix<T>::near_entries(const std::vector<std::int32_t>& places) const {
  const Index n = Index(places.size());
  Eigen::MatrixXf entries = Eigen::MatrixXf::Zero(components * n, components * n);
  for (Index r = 0, next; r < n; r = next) {  // rows of one tile at once, columns as they are stored
    const std::int32_t panel = places[r] / std::int32_t(kPanel), row_leaf = leaf_of_place_[places[r]];
    for (next = r + 1; next < n && places[next] / std::int32_t(kPanel) == panel;) ++next;
    const Index tile = tree_row(panel * std::int32_t(kPanel) - tree_.clusters()[row_leaf].begin, 0, components);
    std::int32_t column_leaf = -1;
    Index first = -1;
    for (Index c = 0; c < n; ++c) {
      if (leaf_of_place_[places[c]] != column_leaf) {
        column_leaf = leaf_of_place_[places[c]];
        first = near_column(row_leaf, column_leaf);
      }
      if (first < 0) continue;
      const std::int32_t column_place = places[c] - tree_.clusters()[column_leaf].begin;
      for (int j = 0; j < components; ++j) {
        T numbers[kTile];
        downwards_.get_column(out_[row_leaf], tile, first + tree_row(column_place, j, components), numbers);
        for (Index k = r; k < next; ++k) {
          for (int i = 0; i < components; ++i) {
            entries(components * k + i, components * c + j) =
                float(numbers[i * Index(kPanel) + places[k] % Index(kPanel)]);
          }
        }
      }
    }
  }
  for (Index k = 0; k < n; ++k) {
    entries.block<components, components>(components * k, components * k) += diagonal_[places[k]].cast<float>();
  }
  for (Index k = 0; k < Index(exact_places_.size()); ++k) {
    const auto found = std::find(places.begin(), places.end(), exact_places_[k]);
    if (found == places.end()) continue;
    for (Index c = 0; c < components * n; ++c) {
      entries.block<components, 1>(components * (found - places.begin()), c) =
          exact_rows_
              .block<components, 1>(components * k, tree_row(places[c / components], int(c % components), components))
              .template cast<float>();
    }
  }
  return entries;
}

double predict_rank(double tolerance) {
  // measured: 38, 57, 72, 90, 108, 125 at 1.4e-3, 1.4e-4, 2.9e-5, 7e-6, 1.4e-6, 1.4e-7 and below
  return std::clamp(-24 - 22 * std::log10(tolerance), 16.0, 127.0);
}

std::size_t predict_compressed_bytes(const TriangleMesh& mesh, const CompressionOptions& options,
                                     std::size_t number_bytes) {
  const ClusterTree tree(mesh);
  const BlockPartition partition(tree, options.eta);
  const std::vector<bool> has_far_field = partition.has_far_field(tree);
  constexpr double components = 3;
  const double rank = predict_rank(options.tolerance);
  double bytes = 0;
  for (std::size_t c = 0; c < tree.clusters().size(); ++c) {
    const Cluster& cluster = tree.clusters()[c];
    const double dofs = components * cluster.size();
    double numbers = 0;
    for (const std::int32_t other : partition.near[c]) numbers += dofs * components * tree.clusters()[other].size();
    if (has_far_field[c]) numbers += 2 * rank * (cluster.is_leaf() ? dofs : 2 * rank);
    const bool packed = options.packed && number_bytes == sizeof(float) && cluster.size() <= most_packed_vertices;
    bytes += numbers * (packed ? sizeof(std::int16_t) + sizeof(float) / double(kTile) : double(number_bytes));
  }
  return static_cast<std::size_t>(bytes);
}

template class CompressedMatrix<float>;
template class CompressedMatrix<double>;

}  // namespace skinbem
