// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <mutex>
#include <optional>
#include <random>
#include <sstream>

#include <skinbem/solve/lu.hpp>
#include <skinbem/solve/neumann_solver.hpp>

namespace skinbem {
namespace {

class DenseSolver final : public NeumannSolver {
 public:
  DenseSolver(RowMajorMatrix H, const Eigen::MatrixXd& B, double tolerance, SharedCurvature curvature)
      : A_(std::move(H)), B_(B), tolerance_(tolerance), curvature_(std::move(curvature)) {
    if (A_.rows() != A_.cols() || B_.rows() != A_.rows() || B_.cols() != 6) {
      throw Error(ErrorCode::usage, "dense solver: H must be 3N by 3N and B 3N by 6");
    }
    A_.noalias() += B_ * B_.transpose();
    single_.emplace(system<float>());
    contraction_ = measure_contraction();
  }

  Eigen::MatrixXd solve(const Eigen::MatrixXd& G, SolveSummary* summary) const override {
    SolveSummary ended;
    Eigen::MatrixXd Y = refine(G, ended, contraction_, [&](const Eigen::MatrixXd& r) { return solve_in_single(r); });
    if (!(ended.residual <= tolerance_)) {
      std::call_once(double_made_, [&] { double_.emplace(system<double>()); });
      constexpr double unknown = std::numeric_limits<double>::infinity();
      Y = refine(G, ended, unknown, [&](const Eigen::MatrixXd& r) { return double_->solve(r); });
    }
    if (!(ended.residual <= std::max(tolerance_, 1e-9))) {
      std::ostringstream message;
      message << "the boundary element system is close to singular: residual " << ended.residual << " instead of "
              << tolerance_ << "; check the mesh and Poisson's ratio";
      throw Error(ErrorCode::numerical, message.str());
    }
    if (summary) *summary = ended;
    return Y;
  }

  Eigen::MatrixXd apply_H(const Eigen::MatrixXd& V) const override {
    Eigen::MatrixXd result = -B_ * (B_.transpose() * V);
    add_product(1, V, result);
    return result;
  }

 private:
  Eigen::MatrixXd solve_in_single(const Eigen::MatrixXd& r) const {
    return single_->solve(r.cast<float>()).cast<double>();
  }

  /// Ten times what a step of refinement leaves of a residual that a step before it has left: |E r| / |r|,
  /// E = I - A S, of r = E w for random w.
  double measure_contraction() const {
    constexpr double safety = 10;
    std::minstd_rand random;
    Eigen::MatrixXd r(A_.rows(), 3);
    for (double& sign : r.reshaped()) sign = random() < random.max() / 2 ? -1 : 1;
    Eigen::RowVectorXd before;
    for (int step = 0; step < 2; ++step) {
      before = r.colwise().norm();
      add_system_product(-1, solve_in_single(r), r);
    }
    return safety * (r.colwise().norm().array() / before.array()).maxCoeff();
  }

  /// Iterative refinement (Wilkinson): y += S (g - A y) with S an approximate inverse, until the residual meets the
  /// tolerance, is sure to by `contraction`, or no longer falls. Each column is scaled to unit size, so that single
  /// precision does not over- or underflow.
  template <class Inverse>
  Eigen::MatrixXd refine(const Eigen::MatrixXd& G, SolveSummary& ended, double contraction,
                         const Inverse& inverse) const {
    const Eigen::RowVectorXd size = G.colwise().norm().cwiseMax(std::numeric_limits<double>::min());
    const Eigen::MatrixXd g = G.array().rowwise() / size.array();
    Eigen::MatrixXd step = inverse(g);
    Eigen::MatrixXd Y = step;
    ended.residual = std::numeric_limits<double>::infinity();
    constexpr int most_steps = 20;
    for (ended.iterations = 0;; ++ended.iterations) {
      Eigen::MatrixXd r = g;
      add_system_product(-1, Y, r);
      const double residual = r.colwise().norm().maxCoeff();
      if (!(residual < ended.residual)) {  // the last step made it worse
        Y -= step;
        break;
      }
      const bool falls = residual < 0.5 * ended.residual;
      ended.residual = residual;
      if (residual <= tolerance_ || !falls || ended.iterations == most_steps) break;
      step = inverse(r);
      Y += step;
      if (contraction * residual <= tolerance_) {  // the product that would show it takes as long as a step
        ended.residual = contraction * residual;
        ++ended.iterations;
        break;
      }
    }
    return Y.array().rowwise() * size.array();
  }

  /// The matrix of the system as such.
  template <class T>
  Rows<T> system() const {
    Rows<T> M = A_.cast<T>();
    if (!curvature_) return M;
#pragma omp parallel for schedule(dynamic, 1)
    for (Index first = 0; first < M.rows(); first += Band<T>::RowsAtCompileTime) {
      const Index rows = std::min<Index>(Band<T>::RowsAtCompileTime, M.rows() - first);
      M.middleRows(first, rows) += curved_part<T>(first, rows).topRows(rows);
    }
    return M;
  }

  /// Rows of some vertices, of a size that the compiler knows.
  template <class T>
  using Band = Eigen::Matrix<T, 24, Eigen::Dynamic>;

  /// Rows of (H - C) S, filled up.
  template <class T>
  Band<T> curved_part(Index first, Index rows) const {
    Band<T> H = Band<T>::Zero(Band<T>::RowsAtCompileTime, A_.cols());
    H.topRows(rows) = A_.middleRows(first, rows).template cast<T>();
    H.topRows(rows) -= (B_.middleRows(first, rows) * B_.transpose()).template cast<T>();
    for (Index row = 0; row < rows; row += 3) {
      const Index vertex = (first + row) / 3;
      H.template block<3, 3>(row, 3 * vertex) -= curvature_->free_terms()[std::size_t(vertex)].template cast<T>();
    }
    Band<T> result = Band<T>::Zero(Band<T>::RowsAtCompileTime, A_.cols());
    for (std::size_t k = 0; k < curvature_->of_displacements().size(); ++k) {
      const auto of_vertex = H.template middleCols<3>(3 * Index(k));
      for (const auto& [column, block] : curvature_->of_displacements()[k]) {
        result.template middleCols<3>(3 * Index(column)) += of_vertex.lazyProduct(block.template cast<T>());
      }
    }
    return result;
  }

  /// result += alpha times system() V.
  void add_system_product(double alpha, const Eigen::MatrixXd& V, Eigen::MatrixXd& result) const {
    if (!curvature_) return add_product(alpha, V, result);
    const Eigen::MatrixXd s = curvature_->of_displacements(V);
    add_product(alpha, V + s, result);
    result -= alpha * (B_ * (B_.transpose() * s) + curvature_->free_part(s));
  }

  /// result += alpha A V.
  void add_product(double alpha, const Eigen::MatrixXd& V, Eigen::MatrixXd& result) const {
    if (V.cols() > few_columns) return lapack::add_product(alpha, A_, V, result);
    constexpr Index band = 64;
#pragma omp parallel for schedule(static)
    for (Index first = 0; first < A_.rows(); first += band) {
      const Index rows = std::min(band, A_.rows() - first);
      add_row_product<double>(alpha, A_.middleRows(first, rows), V, result.middleRows(first, rows));
    }
  }

  RowMajorMatrix A_;  ///< H + B B^T
  Eigen::MatrixXd B_;
  double tolerance_;
  SharedCurvature curvature_;  ///< none where displacements are linear between the vertices
  std::optional<Lu<float>> single_;
  double contraction_;  ///< of a residual, by one step of refinement with it: at most
  mutable std::optional<Lu<double>> double_;
  mutable std::once_flag double_made_;
};

}  // namespace

std::unique_ptr<NeumannSolver> make_dense_solver(RowMajorMatrix H, const Eigen::MatrixXd& B, double tolerance,
                                                 SharedCurvature curvature) {
  return std::make_unique<DenseSolver>(std::move(H), B, tolerance, std::move(curvature));
}

}  // namespace skinbem
