// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/hmatrix/nested_basis.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <random>
#include <tuple>

#include <skinbem/base/lapack.hpp>
#include <skinbem/hmatrix/tile_product.hpp>
#include <skinbem/mesh/adjacency.hpp>

namespace skinbem {
namespace {

using MatrixMap = Eigen::Map<Eigen::MatrixXd>;

/// A matrix in memory that a thread keeps: fresh pages for every cluster would cost more than the work. One for each
/// `use`; not initialised.
enum class Use { field, sums, kept, hats, gram, factor, count };
MatrixMap scratch(Use use, Index rows, Index columns) {
  thread_local std::vector<double> storage[static_cast<int>(Use::count)];
  std::vector<double>& numbers = storage[static_cast<int>(use)];
  if (numbers.size() < static_cast<std::size_t>(rows * columns))
    numbers.resize(static_cast<std::size_t>(rows * columns));
  return {numbers.data(), rows, columns};
}

/// A basis, and what it misses of the field at samples that it was not made from: Frobenius norm, relative.
struct CheckedBasis {
  ClusterBasis basis;
  double missed = 0;
};

/// Where a basis misses more than so many tolerances, it is made anew.
constexpr double too_much = 2;

/// Builds one cluster's bases. A matrix's rows are the equations of the samples, weighted; the last of them check.
template <class Kernel>
class BasisMaker {
 public:
  static constexpr int components = Kernel::components;

  BasisMaker(const ClusterTree& tree, const IndexLists& triangles, const Collocation<Kernel>& collocation,
             const PointKernel<Kernel>& kernel, const FarSamples& samples, double tolerance)
      : tree_(tree),
        triangles_(triangles),
        collocation_(collocation),
        kernel_(kernel),
        samples_(samples),
        tolerance_(tolerance),
        equations_(Index(samples.places.size()) * components) {}

  CheckedBasis row_basis(const Cluster& cluster, const std::vector<ClusterBasis>& bases) const {
    const std::vector<Dof> candidates = cluster.is_leaf() ? vertex_dofs(cluster) : skeletons(cluster, bases);
    const MatrixMap A = field_at(candidates);
    ColumnSelection selection = decompose(A);
    const double missed = missed_of(A, A, selection.columns, selection.weights);
    if (cluster.is_leaf()) selection.weights = fill_up(cluster, selection.weights);
    return {basis(candidates, std::move(selection)), missed};
  }

  CheckedBasis column_basis(const Cluster& cluster, const std::vector<ClusterBasis>& bases) const {
    if (cluster.is_leaf()) return leaf_columns(cluster);
    const std::vector<Dof> candidates = skeletons(cluster, bases);
    const MatrixMap A = field_of(candidates);
    ColumnSelection selection = decompose(A);
    const double missed = missed_of(A, A, selection.columns, selection.weights);
    return {by_components(basis(candidates, std::move(selection))), missed};
  }

 private:
  static std::vector<Dof> all_components(const std::vector<std::int32_t>& points) {
    std::vector<Dof> dofs;
    for (const std::int32_t point : points) {
      for (std::int32_t component = 0; component < components; ++component) dofs.push_back({point, component});
    }
    return dofs;
  }
  static std::vector<std::int32_t> places_of(const Cluster& leaf) {
    std::vector<std::int32_t> places(leaf.size());
    std::iota(places.begin(), places.end(), leaf.begin);
    return places;
  }
  static std::vector<Dof> vertex_dofs(const Cluster& leaf) { return all_components(places_of(leaf)); }
  enum class Around { two_triangles, all_triangles };
  /// On triangles around the leaf's vertices. Two of each vertex are as many as a closed mesh has: the first, and one
  /// from the middle of what is left, since at an edge the first two may be on one face.
  std::vector<Dof> dipole_dofs(const Cluster& leaf, Around around) const {
    std::vector<std::int32_t> found, left;
    for (const std::int32_t place : places_of(leaf)) {
      left.clear();
      for (const std::int32_t t : triangles_[tree_.order()[place]]) {
        if (std::find(found.begin(), found.end(), t) == found.end()) left.push_back(t);
      }
      if (around == Around::two_triangles && left.size() > 2) left = {left.front(), left[left.size() / 2]};
      found.insert(found.end(), left.begin(), left.end());
    }
    return all_components(found);
  }
  static std::vector<Dof> skeletons(const Cluster& cluster, const std::vector<ClusterBasis>& bases) {
    std::vector<Dof> dofs;
    for (const std::int32_t child : cluster.children) {
      dofs.insert(dofs.end(), bases[child].skeleton.begin(), bases[child].skeleton.end());
    }
    return dofs;
  }
  /// From dipoles on two triangles a vertex, or on all where these miss too much: a vertex apart from the others of its
  /// leaf needs all of its own. Tight tolerances always need all.
  CheckedBasis leaf_columns(const Cluster& leaf) const {
    constexpr double tight = 1e-5;
    if (tolerance_ >= tight) {
      FittedDipoles few = dipoles_like_hats(leaf, dipole_dofs(leaf, Around::two_triangles));
      if (few.misfit <= too_much * tolerance_) return std::move(few.dipoles);
    }
    return dipoles_like_hats(leaf, dipole_dofs(leaf, Around::all_triangles)).dipoles;
  }

  struct FittedDipoles {
    CheckedBasis dipoles;
    double misfit;  ///< as CheckedBasis::missed, at the samples that they are made from
  };
  /// There are many more dipoles around a leaf than it takes: they are chosen by fewer equations, and only what those
  /// chosen weigh is found from all of them.
  FittedDipoles dipoles_like_hats(const Cluster& leaf, const std::vector<Dof>& dipoles) const {
    const MatrixMap A = field_of(dipoles);
    MatrixMap gram = scratch(Use::gram, A.cols(), A.cols());
    lapack::gram_matrix(random_sums(A), gram);
    const std::vector<std::int32_t> chosen = select_columns(gram, tolerance_).columns;

    MatrixMap kept = scratch(Use::kept, equations_, Index(chosen.size()));
    std::vector<Dof> candidates;
    for (std::size_t k = 0; k < chosen.size(); ++k) {
      kept.col(Index(k)) = A.col(chosen[k]);
      candidates.push_back(dipoles[chosen[k]]);
    }
    const MatrixMap hats = field_of_hats(leaf);
    MatrixMap products = scratch(Use::gram, kept.cols() + hats.cols(), kept.cols());
    lapack::gram_matrix(fitted(kept), products.topRows(kept.cols()));
    const auto of_hats = products.bottomRows(hats.cols());
    lapack::transposed_product(fitted(hats), fitted(kept), of_hats);
    ColumnSelection all = select_columns(products, 0);
    const Eigen::MatrixXd weights = all.weights.bottomRows(hats.cols());
    double explained = 0;  // least squares: |hats|^2 - |what is missed|^2
    for (std::size_t k = 0; k < all.columns.size(); ++k)
      explained += weights.col(Index(k)).dot(of_hats.col(all.columns[k]));
    const double whole = fitted(hats).squaredNorm(), missed = missed_of(hats, kept, all.columns, weights);
    all.weights = fill_up(leaf, weights);
    return {{by_components(basis(candidates, std::move(all))), missed},
            std::sqrt(std::max(0.0, whole - explained) / whole)};
  }

  /// The equations that bases are made from, and those that check them.
  auto fitted(const MatrixMap& A) const { return A.topRows(equations_ - checks); }
  static auto checking(const MatrixMap& A) { return A.bottomRows(checks); }
  ColumnSelection decompose(const MatrixMap& A) const {
    MatrixMap gram = scratch(Use::gram, A.cols(), A.cols());
    lapack::gram_matrix(fitted(A), gram);
    return select_columns(gram, tolerance_);
  }
  /// What the chosen columns of `by` miss of the fields `of` where these are checked.
  static double missed_of(const MatrixMap& of, const MatrixMap& by, const std::vector<std::int32_t>& chosen,
                          const Eigen::Ref<const Eigen::MatrixXd>& weights) {
    Eigen::MatrixXd skeleton(checks, Index(chosen.size()));
    for (std::size_t k = 0; k < chosen.size(); ++k) skeleton.col(Index(k)) = checking(by).col(chosen[k]);
    const Eigen::MatrixXd missed = checking(of) - skeleton * weights.transpose();
    return missed.norm() / std::max(checking(of).norm(), std::numeric_limits<double>::min());
  }

  static ClusterBasis basis(const std::vector<Dof>& candidates, ColumnSelection selection) {
    ClusterBasis result;
    for (const std::int32_t k : selection.columns) result.skeleton.push_back(candidates[k]);
    result.interpolation = std::move(selection.weights);
    return result;
  }
  /// In the order of DipoleColumns: dipoles of which the same components are there stand together.
  static ClusterBasis by_components(ClusterBasis columns) {
    const std::vector<Dof> dofs = columns.skeleton;
    const PointList list(dofs);
    std::vector<unsigned> set(list.points.size());
    for (std::size_t k = 0; k < dofs.size(); ++k) set[list.of_dof[k]] |= 1u << dofs[k].component;
    Eigen::VectorXi order = Eigen::VectorXi::LinSpaced(Index(dofs.size()), 0, int(dofs.size()) - 1);
    const auto key = [&](int k) { return std::tuple(set[list.of_dof[k]], dofs[k].point, dofs[k].component); };
    std::sort(order.begin(), order.end(), [&](int a, int b) { return key(a) < key(b); });
    for (std::size_t k = 0; k < dofs.size(); ++k) columns.skeleton[k] = dofs[order[Index(k)]];
    columns.interpolation = columns.interpolation * Eigen::PermutationMatrix<Eigen::Dynamic>(order);  // in place
    return columns;
  }
  /// From vertex by vertex to the order of a leaf's tiles.
  static Eigen::MatrixXd fill_up(const Cluster& leaf, const Eigen::MatrixXd& weights) {
    const Index panels = (leaf.size() + Index(kPanel) - 1) / Index(kPanel);
    Eigen::MatrixXd result = Eigen::MatrixXd::Zero(panels * Index(kPanel) * components, weights.cols());
    for (Index v = 0; v < leaf.size(); ++v) {
      for (int i = 0; i < components; ++i) {
        result.row(tree_row(v, i, components)) = weights.row(components * v + i);
      }
    }
    return result;
  }

  /// Column k: the field at degree of freedom k of dipoles at the samples.
  MatrixMap field_at(const std::vector<Dof>& dofs) const {
    const PointList list(dofs);
    const std::size_t sources = samples_.triangles.size();
    const double* values = kernel_.values(list.points, samples_.triangles);
    MatrixMap A = scratch(Use::field, equations_, Index(dofs.size()));
    for (std::size_t k = 0; k < dofs.size(); ++k) {
      const std::size_t point = list.of_dof[k];
      const double* from =
          values + (point / kPanel * sources * entries + components * dofs[k].component) * kPanel + point % kPanel;
      for (std::size_t q = 0; q < sources; ++q) {
        for (int j = 0; j < components; ++j) {
          A(components * Index(q) + j, Index(k)) = samples_.area_root[q] * from[(q * entries + j) * kPanel];
        }
      }
    }
    return A;
  }

  /// Column k: the field at the samples of dipole k.
  MatrixMap field_of(const std::vector<Dof>& dofs) const {
    const PointList list(dofs);
    const double* values = kernel_.values(samples_.places, list.points);
    MatrixMap A = scratch(Use::field, equations_, Index(dofs.size()));
    for (std::size_t k = 0; k < dofs.size(); ++k) {
      for (std::size_t first = 0; first < samples_.places.size(); first += kPanel) {
        const std::size_t block = first / kPanel * list.points.size() + list.of_dof[k];
        copy_panel(values + (block * entries + dofs[k].component) * kPanel, first, A.col(Index(k)));
      }
    }
    return A;
  }

  /// Column k: the field at the samples of the leaf's hat function k.
  MatrixMap field_of_hats(const Cluster& leaf) const {
    std::vector<std::int32_t> rows;
    for (const std::int32_t place : samples_.places) rows.push_back(tree_.order()[place]);
    const auto columns = std::span(tree_.order()).subspan(leaf.begin, leaf.size());
    MatrixMap A = scratch(Use::hats, equations_, leaf.size() * components);
    collocation_.for_double_layer_panels(rows, columns, [&](std::size_t first, std::size_t, const double* values) {
      for (Index k = 0; k < A.cols(); ++k) {
        copy_panel(values + (k / components * Index(entries) + k % components) * Index(kPanel), first, A.col(k));
      }
    });
    return A;
  }

  /// Half as many equations, each the sum of some with random signs: what is large in A is large in them too (Clarkson
  /// and Woodruff, Low rank approximation and regression in input sparsity time, 2013).
  MatrixMap random_sums(const MatrixMap& A) const {
    constexpr Index panel = components * Index(kPanel);
    const Index equations = fitted(A).rows(), sums = std::max(Index(1), equations / panel / 2) * panel;
    MatrixMap S = scratch(Use::sums, sums, A.cols());
    S.setZero();
    std::minstd_rand random;
    Eigen::VectorXd sign(equations);
    for (double& s : sign) s = random() < random.max() / 2 ? -1 : 1;
    for (Index k = 0; k < A.cols(); ++k) {
      for (Index first = 0; first < equations; first += sums) {
        const Index count = std::min(sums, equations - first);
        S.col(k).head(count) += sign.segment(first, count).cwiseProduct(A.col(k).segment(first, count));
      }
    }
    return S;
  }

  /// The equations of a panel of samples; `from` is entry (0, j).
  void copy_panel(const double* from, std::size_t first, Eigen::Ref<Eigen::VectorXd> column) const {
    for (int i = 0; i < components; ++i) {
      for (std::size_t p = 0; p < kPanel; ++p) {
        column[Index(first) * components + i * Index(kPanel) + Index(p)] =
            samples_.area_root[first + p] * from[i * components * kPanel + p];
      }
    }
  }

  static constexpr std::size_t entries = components * components;
  static constexpr Index checks = components * Index(kPanel);  ///< the last equations
  const ClusterTree& tree_;
  const IndexLists& triangles_;
  const Collocation<Kernel>& collocation_;
  const PointKernel<Kernel>& kernel_;
  const FarSamples& samples_;
  double tolerance_;
  Index equations_;
};

}  // namespace

PointList::PointList(const std::vector<Dof>& dofs) {
  for (const Dof& dof : dofs) points.push_back(dof.point);
  std::sort(points.begin(), points.end());
  points.erase(std::unique(points.begin(), points.end()), points.end());
  for (const Dof& dof : dofs) {
    of_dof.push_back(std::lower_bound(points.begin(), points.end(), dof.point) - points.begin());
  }
}

ColumnSelection select_columns(const Eigen::Ref<const Eigen::MatrixXd>& gram, double tolerance) {
  const Index rows = gram.rows(), n = gram.cols();
  Eigen::VectorXd left = gram.topRows(n).diagonal();  // squared norms of what is not yet represented
  const double total = left.sum(), largest = n > 0 ? left.maxCoeff() : 0;
  MatrixMap L = scratch(Use::factor, rows, n);
  ColumnSelection result;
  constexpr double rounding = 1e-13;
  for (Index r = 0; r < n; ++r) {
    const bool done = left.cwiseMax(0.0).sum() <= tolerance * tolerance * total;
    Index pivot = 0;
    if (left.maxCoeff(&pivot) <= rounding * largest || (done && r % Index(kTileStep) == 0)) break;
    // column `pivot` of the Gram matrix, of which only the lower half is there
    auto column = L.col(r);
    column.head(pivot) = gram.row(pivot).head(pivot).transpose();
    column.tail(rows - pivot) = gram.col(pivot).tail(rows - pivot);
    lapack::subtract_product(L.data(), int(rows), int(r), int(rows), L.data() + pivot, int(rows), column.data());
    column /= std::sqrt(column[pivot]);
    left -= column.head(n).cwiseAbs2();
    left[pivot] = 0;
    result.columns.push_back(static_cast<std::int32_t>(pivot));
  }
  const Index rank = Index(result.columns.size());
  Eigen::MatrixXd skeleton(rank, rank);
  for (Index k = 0; k < rank; ++k) skeleton.row(k) = L.row(result.columns[k]).head(rank);
  result.weights = lapack::right_solve_lower(skeleton, L.leftCols(rank));
  return result;
}

template <class Kernel>
NestedBases make_nested_bases(const TriangleMesh& mesh, const ClusterTree& tree, const BlockPartition& partition,
                              const Collocation<Kernel>& collocation, const PointKernel<Kernel>& kernel,
                              const BasisOptions& options, const std::function<void(double)>& done) {
  const FarSampler sampler(mesh, tree, partition);
  const IndexLists triangles = triangles_around_vertices(mesh);
  const std::size_t count = tree.clusters().size();
  NestedBases bases{std::vector<ClusterBasis>(count), std::vector<ClusterBasis>(count)};
  const auto misses_too_much = [&](const CheckedBasis& made) { return made.missed > too_much * options.tolerance; };
  const auto make_bases = [&](std::int32_t c) {
    const FarSamples samples = sampler.samples(c, options.samples);
    if (samples.places.empty()) return;
    const Cluster& cluster = tree.clusters()[c];
    const BasisMaker<Kernel> maker(tree, triangles, collocation, kernel, samples, options.tolerance);
    CheckedBasis rows = maker.row_basis(cluster, bases.rows), columns = maker.column_basis(cluster, bases.columns);
    if (misses_too_much(rows) || misses_too_much(columns)) {
      const FarSamples more = sampler.samples(c, 2 * options.samples);
      const BasisMaker<Kernel> careful(tree, triangles, collocation, kernel, more, options.tolerance);
      if (misses_too_much(rows)) rows = careful.row_basis(cluster, bases.rows);
      if (misses_too_much(columns)) columns = careful.column_basis(cluster, bases.columns);
    }
    bases.rows[c] = std::move(rows.basis);
    bases.columns[c] = std::move(columns.basis);
  };
  for (std::size_t level = tree.levels().size() - 1; level-- > 0;) {
#pragma omp parallel for schedule(dynamic, 1)
    for (std::int32_t c = tree.levels()[level]; c < tree.levels()[level + 1]; ++c) make_bases(c);
    done(1 - double(tree.levels()[level]) / double(count));
  }
  return bases;
}

template NestedBases make_nested_bases(const TriangleMesh&, const ClusterTree&, const BlockPartition&,
                                       const Collocation<Kelvin<double>>&, const PointKernel<Kelvin<double>>&,
                                       const BasisOptions&, const std::function<void(double)>&);

}  // namespace skinbem
