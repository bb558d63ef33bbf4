// SPDX-License-Identifier: BSD-3-Clause
#include "stiffness_matrix.hpp"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <skinbem/base/error.hpp>

namespace skinbem::bench {
namespace {

struct Element {
  Eigen::Matrix<double, 4, 3> gradients;
  double volume;
};

Element element(const TetrahedralMesh& mesh, Index e) {
  Mat3 edges;
  for (int a = 0; a < 3; ++a) {
    edges.row(a) = mesh.nodes.row(mesh.tetrahedra(e, a + 1)) - mesh.nodes.row(mesh.tetrahedra(e, 0));
  }
  Element result;
  result.gradients.bottomRows<3>() = edges.inverse().transpose();
  result.gradients.row(0) = -result.gradients.bottomRows<3>().colwise().sum();
  result.volume = edges.determinant() / 6;
  return result;
}

/// The block of nodes a (rows) and b (columns).
Mat3 block(const Element& element, int a, int b, double lambda) {
  const Vec3 ga = element.gradients.row(a), gb = element.gradients.row(b);
  return element.volume * (lambda * ga * gb.transpose() + gb * ga.transpose() + ga.dot(gb) * Mat3::Identity());
}

/// Rows and offsets of the three columns of each node; the values zero.
LowerTriangle pattern(const IndexLists& neighbours) {
  LowerTriangle K;
  K.offsets.assign(1, 0);
  for (Index b = 0; b < neighbours.size(); ++b) {
    for (int j = 0; j < 3; ++j) {
      for (const std::int32_t a : neighbours[b]) {
        for (int i = a == b ? j : 0; i < 3; ++i) K.rows.push_back(3 * SuiteSparse_long(a) + i);
      }
      K.offsets.push_back(static_cast<SuiteSparse_long>(K.rows.size()));
    }
  }
  K.values.assign(K.rows.size(), 0);
  return K;
}

/// Adds `values` to the block of columns of node b whose rows belong to its neighbour number `slot`.
void add_block(LowerTriangle& K, Index b, Index slot, const Mat3& values) {
  for (int j = 0; j < 3; ++j) {
    double* column = K.values.data() + K.offsets[static_cast<std::size_t>(3 * b + j)];
    for (int i = slot == 0 ? j : 0; i < 3; ++i) column[3 * slot + i - j] += values(i, j);
  }
}

/// Rows and columns of the unit matrix: what is held does not move.
void hold(LowerTriangle& K, std::span<const Index> held) {
  std::vector<char> is_held(K.offsets.size(), 0);
  for (const Index i : held) is_held[i] = 1;
  for (Index j = 0; j + 1 < Index(K.offsets.size()); ++j) {
    for (auto p = K.offsets[j]; p < K.offsets[j + 1]; ++p) {
      if (is_held[j] || is_held[K.rows[p]]) K.values[p] = K.rows[p] == j ? 1 : 0;
    }
  }
}

/// A view, without ownership, of a lower triangle; without values it is a pattern.
cholmod_sparse view(std::vector<SuiteSparse_long>& offsets, std::vector<SuiteSparse_long>& rows, double* values) {
  cholmod_sparse A{};
  A.nrow = A.ncol = offsets.size() - 1;
  A.nzmax = rows.size();
  A.p = offsets.data();
  A.i = rows.data();
  A.x = values;
  A.stype = -1;
  A.itype = CHOLMOD_LONG;
  A.xtype = values ? CHOLMOD_REAL : CHOLMOD_PATTERN;
  A.dtype = CHOLMOD_DOUBLE;
  A.sorted = A.packed = 1;
  return A;
}

/// Three unknowns a node, in the order of nested dissection of the nodes.
std::vector<SuiteSparse_long> dissection(const IndexLists& neighbours, cholmod_common& common) {
  std::vector<SuiteSparse_long> offsets{0}, rows;
  for (Index b = 0; b < neighbours.size(); ++b) {
    rows.insert(rows.end(), neighbours[b].begin(), neighbours[b].end());
    offsets.push_back(static_cast<SuiteSparse_long>(rows.size()));
  }
  cholmod_sparse graph = view(offsets, rows, nullptr);
  std::vector<SuiteSparse_long> order(graph.nrow), parent(graph.nrow), part(graph.nrow), unknowns;
  const auto parts = cholmod_l_nested_dissection(&graph, nullptr, 0, order.data(), parent.data(), part.data(), &common);
  if (parts < 0) return {};
  for (const SuiteSparse_long node : order) {
    for (int i = 0; i < 3; ++i) unknowns.push_back(3 * node + i);
  }
  return unknowns;
}

}  // namespace

IndexLists lower_neighbours(const TetrahedralMesh& mesh, const IndexLists& around) {
  std::vector<std::int32_t> offsets{0}, items;
  for (Index b = 0; b < mesh.nodes.rows(); ++b) {
    const auto begin = static_cast<std::ptrdiff_t>(items.size());
    for (const std::int32_t e : around[b]) {
      for (const std::int32_t a : mesh.tetrahedra.row(e)) {
        if (a >= b) items.push_back(a);
      }
    }
    std::sort(items.begin() + begin, items.end());
    items.erase(std::unique(items.begin() + begin, items.end()), items.end());
    offsets.push_back(static_cast<std::int32_t>(items.size()));
  }
  return {std::move(offsets), std::move(items)};
}

LowerTriangle stiffness_matrix(const TetrahedralMesh& mesh, const IndexLists& neighbours, double poisson,
                               std::span<const Index> held) {
  const double lambda = 2 * poisson / (1 - 2 * poisson);
  const IndexLists around = tetrahedra_around_nodes(mesh);
  LowerTriangle K = pattern(neighbours);
#pragma omp parallel for schedule(dynamic, 256)
  for (Index b = 0; b < mesh.nodes.rows(); ++b) {
    const auto rows = neighbours[b];
    for (const std::int32_t e : around[b]) {
      const auto corners = mesh.tetrahedra.row(e);
      const Element here = element(mesh, e);
      const int column = static_cast<int>(std::find(corners.begin(), corners.end(), b) - corners.begin());
      for (int a = 0; a < 4; ++a) {
        if (corners[a] < b) continue;
        const auto slot = std::lower_bound(rows.begin(), rows.end(), corners[a]) - rows.begin();
        add_block(K, b, slot, block(here, a, column, lambda));
      }
    }
  }
  hold(K, held);
  return K;
}

CholeskyFactor::CholeskyFactor(LowerTriangle K, const IndexLists& neighbours) {
  cholmod_l_start(&common_);
  common_.print = 0;  // errors are ours to tell
  common_.supernodal = CHOLMOD_SUPERNODAL;
  std::vector<SuiteSparse_long> order = dissection(neighbours, common_);
  cholmod_sparse A = view(K.offsets, K.rows, K.values.data());
  common_.nmethods = 1;
  common_.method[0].ordering = CHOLMOD_GIVEN;
  if (!order.empty()) factor_ = cholmod_l_analyze_p(&A, order.data(), nullptr, 0, &common_);
  const bool good = factor_ && cholmod_l_factorize(&A, factor_, &common_) && common_.status == CHOLMOD_OK;
  if (!good) {
    const bool memory = common_.status == CHOLMOD_OUT_OF_MEMORY;
    release();
    throw Error(ErrorCode::numerical, memory ? "the Cholesky factor does not fit into the memory"
                                             : "the stiffness matrix is not positive definite");
  }
}

void CholeskyFactor::release() {
  cholmod_l_free_factor(&factor_, &common_);
  cholmod_l_finish(&common_);
}

CholeskyFactor::~CholeskyFactor() { release(); }

Eigen::MatrixXd CholeskyFactor::solve(const Eigen::MatrixXd& loads) {
  Eigen::MatrixXd copy = loads;
  cholmod_dense b{};
  b.nrow = b.d = static_cast<std::size_t>(loads.rows());
  b.ncol = static_cast<std::size_t>(loads.cols());
  b.nzmax = b.nrow * b.ncol;
  b.x = copy.data();
  b.xtype = CHOLMOD_REAL;
  b.dtype = CHOLMOD_DOUBLE;
  cholmod_dense* x = cholmod_l_solve(CHOLMOD_A, factor_, &b, &common_);
  if (!x) throw Error(ErrorCode::numerical, "the solution does not fit into the memory");
  copy = Eigen::Map<const Eigen::MatrixXd>(static_cast<const double*>(x->x), loads.rows(), loads.cols());
  cholmod_l_free_dense(&x, &common_);
  return copy;
}

double CholeskyFactor::bytes() const { return static_cast<double>(factor_->xsize) * sizeof(double); }

}  // namespace skinbem::bench
