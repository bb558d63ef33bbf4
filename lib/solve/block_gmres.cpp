// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/solve/block_gmres.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <vector>

#include <skinbem/base/lapack.hpp>

namespace skinbem {
namespace {

constexpr Index chunk_rows = 2048;

Index chunk_count(Index rows) { return (rows + chunk_rows - 1) / chunk_rows; }

/// W = Q R with orthonormal columns of Q, as many as W has independent directions (singular values above `negligible`,
/// and above 1e-7 of the largest); W becomes Q. Singular vector QR: Stathopoulos and Wu, SIAM J. Sci. Comput. 23
/// (2002), twice for orthogonality.
Eigen::MatrixXd orthonormalise(VectorBlock& W, double negligible) {
  const Index n = W.cols();
  if (n == 0) return Eigen::MatrixXd(0, 0);
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(inner_products(W, W));
  // squares below the rounding errors of the largest are noise, and their vectors no directions
  const double noise = double(n) * std::numeric_limits<double>::epsilon() * eigen.eigenvalues()[n - 1];
  Index kept = 0;
  while (kept < n && eigen.eigenvalues()[n - 1 - kept] > std::max(negligible * negligible, noise)) ++kept;
  const Eigen::VectorXd sigma = eigen.eigenvalues().tail(kept).cwiseSqrt();
  const Eigen::MatrixXd vectors = eigen.eigenvectors().rightCols(kept);
  VectorBlock Q = VectorBlock::Zero(W.rows(), kept);
  add_product(W, vectors * sigma.cwiseInverse().asDiagonal(), Q);
  W.swap(Q);
  return sigma.asDiagonal() * vectors.transpose();
}

/// The least-squares problem of the growing block Hessenberg matrix: each block column is reduced by the reflections
/// of those before it, then by its own, which takes what is below the diagonal block.
class HessenbergSolver {
 public:
  explicit HessenbergSolver(const Eigen::MatrixXd& right) : rotated_(right), starts_{0} {}

  /// A block column, whose last rows are those of the new block.
  void add(Eigen::MatrixXd column) {
    for (std::size_t k = 0; k < reflections_.size(); ++k) reduce(k, column);
    const Index first = starts_.back(), width = column.cols();
    Eigen::HouseholderQR<Eigen::MatrixXd> qr(column.bottomRows(column.rows() - first));
    reflections_.push_back(Eigen::MatrixXd(qr.householderQ()));
    rotated_.conservativeResizeLike(Eigen::MatrixXd::Zero(column.rows(), rotated_.cols()));
    reduce(reflections_.size() - 1, column);
    reduce(reflections_.size() - 1, rotated_);
    columns_.push_back(std::move(column));
    starts_.push_back(first + width);
  }
  /// Norms of what the least-squares solution leaves of each right-hand side.
  Eigen::RowVectorXd residuals() const {
    return rotated_.bottomRows(rotated_.rows() - starts_.back()).colwise().norm();
  }
  Eigen::MatrixXd solution() const {
    const Index n = starts_.back();
    Eigen::MatrixXd upper = Eigen::MatrixXd::Zero(n, n);
    for (std::size_t k = 0; k < columns_.size(); ++k) {
      const Index rows = starts_[k + 1];
      upper.block(0, starts_[k], rows, columns_[k].cols()) = columns_[k].topRows(rows);
    }
    return upper.triangularView<Eigen::Upper>().solve(rotated_.topRows(n));
  }

 private:
  void reduce(std::size_t k, Eigen::MatrixXd& column) const {
    const Eigen::MatrixXd& Q = reflections_[k];
    column.middleRows(starts_[k], Q.rows()) = (Q.transpose() * column.middleRows(starts_[k], Q.rows())).eval();
  }

  Eigen::MatrixXd rotated_;  ///< the right-hand sides
  std::vector<Index> starts_;
  std::vector<Eigen::MatrixXd> reflections_;
  std::vector<Eigen::MatrixXd> columns_;
};

/// One cycle: the correction for the residual R (columns of about unit norm).
VectorBlock cycle(const BlockOperator& A, const BlockOperator& preconditioner, VectorBlock R,
                  const GmresOptions& options, GmresSummary& summary, const Progress& progress) {
  constexpr double negligible = 1e-13;
  constexpr double long_enough = 1e-4;  // then rounding has not turned the directions by more than 1e-12
  const double largest = std::sqrt(inner_products(R, R).diagonal().maxCoeff());
  std::vector<VectorBlock> V;
  Eigen::MatrixXd right = orthonormalise(R, negligible * largest);
  V.push_back(std::move(R));
  HessenbergSolver hessenberg(right);
  VectorBlock Z, W;
  double residual = largest;
  while (summary.iterations < options.most_iterations && residual > options.tolerance && V.back().cols() > 0) {
    preconditioner(V.back(), Z);
    A(Z, W);
    ++summary.iterations;
    Index width = 0;
    for (const auto& block : V) width += block.cols();
    Eigen::MatrixXd column = Eigen::MatrixXd::Zero(width, W.cols());
    Eigen::MatrixXd below = Eigen::MatrixXd::Identity(W.cols(), W.cols());
    double shortest = 0;                                              // of the new directions, before they are scaled
    for (int pass = 0; pass < 2 && shortest < long_enough; ++pass) {  // twice is enough (Kahan), once often is
      Index row = 0;
      for (const auto& block : V) {
        const Eigen::MatrixXd S = inner_products(block, W);
        add_product(block, -S, W);
        column.middleRows(row, block.cols()) += S * below;
        row += block.cols();
      }
      const Eigen::MatrixXd factor = orthonormalise(W, negligible);
      shortest = factor.rows() > 0 ? factor.rowwise().norm().minCoeff() : long_enough;
      below = (factor * below).eval();
    }
    column.conservativeResize(width + W.cols(), Eigen::NoChange);
    column.bottomRows(W.cols()) = below;
    hessenberg.add(std::move(column));
    V.push_back(W);
    residual = hessenberg.residuals().maxCoeff();
    report(progress, "solve", std::clamp(std::log(residual / largest) / std::log(options.tolerance / largest), 0., 1.));
  }
  const Eigen::MatrixXd y = hessenberg.solution();
  VectorBlock sum = VectorBlock::Zero(V.front().rows(), y.cols());
  for (Index k = 0, row = 0; row < y.rows(); row += V[k].cols(), ++k) {
    add_product(V[k], y.middleRows(row, V[k].cols()), sum);
  }
  preconditioner(sum, Z);
  return Z;
}

}  // namespace

Eigen::MatrixXd inner_products(const VectorBlock& V, const VectorBlock& W) {
  const Index chunks = chunk_count(V.rows());
  std::vector<RowMajorMatrix> parts(chunks);
#pragma omp parallel for schedule(static) if (chunks > 1)
  for (Index k = 0; k < chunks; ++k) {
    const Index first = k * chunk_rows, rows = std::min(chunk_rows, V.rows() - first);
    parts[k].resize(V.cols(), W.cols());
    lapack::inner_product(V.data() + first * V.cols(), W.data() + first * W.cols(), rows, parts[k]);
  }
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(V.cols(), W.cols());
  for (const RowMajorMatrix& part : parts) sum += part;
  return sum;
}

void add_product(const VectorBlock& V, const RowMajorMatrix& S, VectorBlock& W) {
  const Index chunks = chunk_count(V.rows());
#pragma omp parallel for schedule(static) if (chunks > 1)
  for (Index k = 0; k < chunks; ++k) {
    const Index first = k * chunk_rows, rows = std::min(chunk_rows, V.rows() - first);
    lapack::add_product(V.data() + first * V.cols(), S, rows, W.data() + first * W.cols());
  }
}

VectorBlock block_gmres(const BlockOperator& A, const BlockOperator& preconditioner, const VectorBlock& G,
                        const GmresOptions& options, GmresSummary& summary, const Progress& progress) {
  const Eigen::RowVectorXd sizes =
      inner_products(G, G).diagonal().transpose().cwiseSqrt().cwiseMax(std::numeric_limits<double>::min());
  const VectorBlock g = G.array().rowwise() / sizes.array();
  VectorBlock Y = VectorBlock::Zero(G.rows(), G.cols());
  VectorBlock R = g, product;
  summary = {0, 1};
  while (summary.iterations < options.most_iterations) {
    const VectorBlock next = Y + cycle(A, preconditioner, R, options, summary, progress);
    A(next, product);
    VectorBlock left = g - product;
    const double residual = std::sqrt(inner_products(left, left).diagonal().maxCoeff());
    if (!(residual < summary.residual)) break;  // rounding has the last word
    const bool stalls = residual > 0.3 * summary.residual;
    Y = next;
    R = std::move(left);
    summary.residual = residual;
    if (residual <= options.tolerance || stalls) break;
  }
  return Y.array().rowwise() * sizes.array();
}

}  // namespace skinbem
