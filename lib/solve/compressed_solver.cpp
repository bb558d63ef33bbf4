// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <sstream>

#include <skinbem/hmatrix/exact_rows.hpp>
#include <skinbem/solve/coarse_correction.hpp>
#include <skinbem/solve/neumann_solver.hpp>
#include <skinbem/solve/schwarz.hpp>

namespace skinbem {
namespace {

template <class T>
class CompressedSolver final : public NeumannSolver {
 public:
  CompressedSolver(const TriangleMesh& mesh, const Collocation<Kelvin<double>>& collocation, const Eigen::MatrixXd& B,
                   const IterativeOptions& options, const Progress& progress)
      : H_(mesh, collocation, options.compression, progress),
        schwarz_(mesh, H_, B),
        exact_(collocation),
        rigid_(B),
        B_(H_.to_tree(B)),
        coarse_(mesh, H_.tree(), H_.rows(), system()),
        gmres_{options.residual},
        progress_(progress) {}

  Eigen::MatrixXd solve(const Eigen::MatrixXd& G, SolveSummary* summary) const override {
    Eigen::MatrixXd Y(G.rows(), G.cols());
    SolveSummary ended;
    const Index blocks = (G.cols() + most_columns - 1) / most_columns;
    for (Index k = 0; k < blocks; ++k) {  // of about equal width
      const Index first = G.cols() * k / blocks, width = G.cols() * (k + 1) / blocks - first;
      GmresSummary block;
      Y.middleCols(first, width) = solve_block(G.middleCols(first, width), block);
      ended.iterations = std::max(ended.iterations, block.iterations);
      ended.residual = std::max(ended.residual, block.residual);
    }
    if (!(ended.residual <= gmres_.tolerance)) {
      std::ostringstream message;
      message << "the iteration did not converge: residual " << ended.residual << " instead of " << gmres_.tolerance
              << " after " << ended.iterations << " block iterations; check the mesh, allow a larger tolerance, or use "
              << "the dense solver";
      throw Error(ErrorCode::numerical, message.str());
    }
    const Eigen::MatrixXd difference =
        exact_.multiply(Y) + exact_.pick(rigid_ * (rigid_.transpose() * Y)) - exact_.pick(G);
    const Eigen::RowVectorXd size = G.colwise().norm().cwiseMax(std::numeric_limits<double>::min());
    ended.sampled_residual = exact_.estimate_norms(difference).cwiseQuotient(size).maxCoeff();
    if (summary) *summary = ended;
    return Y;
  }

  Eigen::MatrixXd apply_H(const Eigen::MatrixXd& V) const override {
    Eigen::MatrixXd result(V.rows(), V.cols());
    VectorBlock product;
    typename CompressedMatrix<T>::Block work;
    for (Index first = 0; first < V.cols(); first += most_columns) {
      const Index width = std::min(most_columns, V.cols() - first);
      H_.multiply(H_.to_tree(V.middleCols(first, width)), product, work);
      result.middleCols(first, width) = H_.from_tree(product);
    }
    return result;
  }

 private:
  /// Of a block of GMRES: more cost more for the basis than they save in iterations.
  static constexpr Index most_columns = 36;
  static_assert(most_columns <= Index(kMostColumns));

  Eigen::MatrixXd solve_block(const Eigen::MatrixXd& G, GmresSummary& summary) const {
    const BlockOperator A = system();
    VectorBlock rest, local;
    const BlockOperator preconditioner = [&](const VectorBlock& in, VectorBlock& out) {
      rest = in;
      coarse_.apply(rest, out);
      schwarz_.apply(rest, local);
      out += local;
    };
    return H_.from_tree(block_gmres(A, preconditioner, H_.to_tree(G), gmres_, summary, progress_));
  }

  /// H + B B^T
  BlockOperator system() const {
    return [this, work = typename CompressedMatrix<T>::Block()](const VectorBlock& in, VectorBlock& out) mutable {
      H_.multiply(in, out, work);
      add_product(B_, inner_products(B_, in), out);
    };
  }

  CompressedMatrix<T> H_;
  SchwarzPreconditioner schwarz_;
  ExactRows exact_;
  Eigen::MatrixXd rigid_;  ///< B in the order of the mesh
  VectorBlock B_;          ///< in the tree's order
  CoarseCorrection coarse_;
  GmresOptions gmres_;
  Progress progress_;
};

}  // namespace

IterativeOptions IterativeOptions::for_tolerance(double tolerance, Index vertices) {
  IterativeOptions options;
  const double levels = std::pow(std::max(1.0, double(vertices) / 1e4), -0.25);  // of the tree, whose errors add up
  options.compression.tolerance = tolerance * levels / (tolerance >= 1e-4 ? 3 : 5);
  options.compression.samples = tolerance >= 1e-4 ? 192 : tolerance >= 1e-5 ? 384 : 640;
  options.residual = std::min(1e-3, 2 * tolerance);
  options.single = tolerance >= 2e-5;
  options.compression.packed = tolerance >= 1e-4;
  return options;
}

std::unique_ptr<NeumannSolver> make_iterative_solver(const TriangleMesh& mesh,
                                                     const Collocation<Kelvin<double>>& collocation,
                                                     const Eigen::MatrixXd& B, const IterativeOptions& options,
                                                     const Progress& progress) {
  if (options.single) return std::make_unique<CompressedSolver<float>>(mesh, collocation, B, options, progress);
  return std::make_unique<CompressedSolver<double>>(mesh, collocation, B, options, progress);
}

}  // namespace skinbem
