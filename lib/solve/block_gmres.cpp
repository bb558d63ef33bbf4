// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/solve/block_gmres.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/QR>
#include <cmath>
#include <limits>
#include <vector>

#include <skinbem/base/lapack.hpp>
#include <skinbem/base/row_chunks.hpp>

namespace skinbem {
namespace {

using detail::for_each_chunk;

/// body(some rows of V, the first of them).
template <class Body>
void in_chunks(VectorBlock& V, const Body& body) {
  for_each_chunk(V.rows(), [&](Index first, Index count) { body(V.middleRows(first, count), first); });
}

VectorBlock zeros(Index rows, Index columns) {
  VectorBlock V(rows, columns);
  in_chunks(V, [](auto part, Index) { part.setZero(); });
  return V;
}

void scale_columns(VectorBlock& V, const Eigen::RowVectorXd& factors) {
  in_chunks(V, [&](auto part, Index) { part.array().rowwise() *= factors.array(); });
}

/// W = W S for a square S.
void multiply_from_right(VectorBlock& W, const RowMajorMatrix& S) {
  in_chunks(W, [&](auto part, Index) {
    RowMajorMatrix product = RowMajorMatrix::Zero(part.rows(), part.cols());
    lapack::add_product(part.data(), S, part.rows(), product.data());
    part = product;
  });
}

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
  const RowMajorMatrix S = vectors * sigma.cwiseInverse().asDiagonal();
  if (kept == n) {
    multiply_from_right(W, S);
  } else {
    VectorBlock Q = zeros(W.rows(), kept);
    add_product(W, S, Q);
    W.swap(Q);
  }
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
    V.push_back(std::move(W));
    W = {};
    residual = hessenberg.residuals().maxCoeff();
    report(progress, "solve", std::clamp(std::log(residual / largest) / std::log(options.tolerance / largest), 0., 1.));
  }
  const Eigen::MatrixXd y = hessenberg.solution();
  VectorBlock sum = zeros(V.front().rows(), y.cols());
  for (Index k = 0, row = 0; row < y.rows(); row += V[k].cols(), ++k) {
    add_product(V[k], y.middleRows(row, V[k].cols()), sum);
  }
  preconditioner(sum, Z);
  return Z;
}

}  // namespace

Eigen::MatrixXd inner_products(const VectorBlock& V, const VectorBlock& W) {
  std::vector<RowMajorMatrix> parts(detail::chunk_count(V.rows()));
  for_each_chunk(V.rows(), [&](Index first, Index count) {
    RowMajorMatrix& part = parts[first / detail::chunk_rows];
    part.resize(V.cols(), W.cols());
    lapack::inner_product(V.data() + first * V.cols(), W.data() + first * W.cols(), count, part);
  });
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(V.cols(), W.cols());
  for (const RowMajorMatrix& part : parts) sum += part;
  return sum;
}

void add_product(const VectorBlock& V, const RowMajorMatrix& S, VectorBlock& W) {
  for_each_chunk(V.rows(), [&](Index first, Index count) {
    lapack::add_product(V.data() + first * V.cols(), S, count, W.data() + first * W.cols());
  });
}

VectorBlock block_gmres(const BlockOperator& A, const BlockOperator& preconditioner, VectorBlock G,
                        const GmresOptions& options, GmresSummary& summary, const Progress& progress) {
  const Eigen::RowVectorXd sizes =
      inner_products(G, G).diagonal().transpose().cwiseSqrt().cwiseMax(std::numeric_limits<double>::min());
  scale_columns(G, sizes.cwiseInverse());
  VectorBlock Y = zeros(G.rows(), G.cols()), R(G.rows(), G.cols());
  in_chunks(R, [&](auto part, Index first) { part = G.middleRows(first, part.rows()); });
  summary = {0, 1};
  while (summary.iterations < options.most_iterations) {
    VectorBlock next = cycle(A, preconditioner, std::move(R), options, summary, progress);
    in_chunks(next, [&](auto part, Index first) { part += Y.middleRows(first, part.rows()); });
    A(next, R);
    in_chunks(R, [&](auto part, Index first) { part = G.middleRows(first, part.rows()) - part; });
    const double residual = std::sqrt(inner_products(R, R).diagonal().maxCoeff());
    if (!(residual < summary.residual)) break;  // rounding has the last word
    const bool stalls = residual > 0.3 * summary.residual;
    Y = std::move(next);
    summary.residual = residual;
    if (residual <= options.tolerance || stalls) break;
  }
  scale_columns(Y, sizes);
  return Y;
}

}  // namespace skinbem
