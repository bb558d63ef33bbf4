// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <cmath>
#include <limits>
#include <optional>
#include <random>
#include <sstream>

#include <skinbem/base/row_chunks.hpp>
#include <skinbem/hmatrix/exact_rows.hpp>
#include <skinbem/solve/coarse_correction.hpp>
#include <skinbem/solve/neumann_solver.hpp>
#include <skinbem/solve/schwarz.hpp>

namespace skinbem {
namespace {

/// RecoveredCurvature for vectors in the tree's order.
class TreeCurvature {
 public:
  TreeCurvature(const RecoveredCurvature& curvature, const ClusterTree& tree) {
    const std::vector<std::int32_t>& order = tree.order();
    std::vector<std::int32_t> place_of(order.size());
    for (std::size_t place = 0; place < order.size(); ++place) place_of[order[place]] = std::int32_t(place);
    for (const std::int32_t vertex : order) {
      rows_.push_back(curvature.of_displacements()[vertex]);
      for (auto& [index, block] : rows_.back()) index = place_of[index];
      free_terms_.push_back(curvature.free_terms()[vertex]);
    }
  }

  /// s = S in. What fills up the last panel is zero.
  void multiply(const VectorBlock& in, VectorBlock& s) const {
    s.setZero(in.rows(), in.cols());
#pragma omp parallel for schedule(static)
    for (std::size_t place = 0; place < rows_.size(); ++place) {
      for (const auto& [other, block] : rows_[place]) add(block, in, std::int32_t(other), s, std::int32_t(place));
    }
  }
  /// out -= C s.
  void subtract_free_part(const VectorBlock& s, VectorBlock& out) const {
#pragma omp parallel for schedule(static)
    for (std::size_t place = 0; place < rows_.size(); ++place) {
      add(-free_terms_[place], s, std::int32_t(place), out, std::int32_t(place));
    }
  }

 private:
  /// The rows of a place of `out` += block times the rows of another of `in`.
  static void add(const Mat3& block, const VectorBlock& in, std::int32_t from, VectorBlock& out, std::int32_t to) {
    const auto x = in.row(tree_row(from, 0, 3)), y = in.row(tree_row(from, 1, 3)), z = in.row(tree_row(from, 2, 3));
    for (int i = 0; i < 3; ++i) {
      out.row(tree_row(to, i, 3)) += block(i, 0) * x + block(i, 1) * y + block(i, 2) * z;
    }
  }

  std::vector<SparseBlockRow> rows_;
  std::vector<Mat3> free_terms_;
};

template <class T>
class CompressedSolver final : public NeumannSolver {
 public:
  CompressedSolver(const TriangleMesh& mesh, const Collocation<Kelvin<double>>& collocation, const Eigen::MatrixXd& B,
                   const IterativeOptions& options, const Progress& progress, const SharedCurvature& curvature)
      : H_(mesh, collocation, options.compression, progress),
        schwarz_(mesh, H_, B),
        B_(H_.to_tree(B)),
        coarse_(mesh, H_, B_, CoarseCorrection::parts_for(mesh.vertex_count())),
        gmres_{options.residual},
        progress_(progress) {
    for (const Mat3& block : H_.diagonal()) inverse_diagonal_.push_back(block.inverse());
    if (curvature) curvature_.emplace(*curvature, H_.tree());
  }

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
              << " after " << ended.iterations << " block iterations; " << advice();
      throw Error(ErrorCode::numerical, message.str());
    }
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

  /// The first vertex of close_to_singular is to blame where there is one.
  std::string advice() const override {
    const std::string otherwise = "allow a larger tolerance, or use the dense solver";
    const auto delicate = close_to_singular(H_.diagonal().size(), [&](std::size_t k) { return H_.diagonal()[k]; });
    if (delicate.empty()) return "check the mesh, " + otherwise;
    return "vertex " + std::to_string(H_.tree().order()[delicate.front()]) +
           " is the tip of a needle, or slivers meet there: move it nearer to its neighbours, " + otherwise;
  }

  void set_residual(double residual) override { gmres_.tolerance = residual; }

  Eigen::MatrixXd random_defects() const override {
    constexpr int probes = 3;
    const std::vector<std::int32_t>& order = H_.tree().order();
    Eigen::MatrixXd defects(3 * Index(order.size()), probes);
    Eigen::Matrix<double, 3, probes> signs = Eigen::Matrix<double, 3, probes>::Zero();
    std::minstd_rand random;
    for (std::size_t place = 0; place < order.size(); ++place) {
      if (place % ClusterTree::leaf_size == 0) {
        for (double& sign : signs.reshaped()) sign = random() < random.max() / 2 ? -1 : 1;
      }
      defects.middleRows<3>(3 * Index(order[place])) = H_.diagonal()[place] * signs;
    }
    for (const std::int32_t place : H_.exact_places()) defects.middleRows<3>(3 * Index(order[place])).setZero();
    return defects;
  }

 private:
  /// Of a block of GMRES: more cost more for the basis than they save in iterations.
  static constexpr Index most_columns = 36;
  static_assert(most_columns <= Index(kMostColumns));

  Eigen::MatrixXd solve_block(const Eigen::MatrixXd& G, GmresSummary& summary) const {
    VectorBlock g = H_.to_tree(G);
    multiply_blocks(inverse_diagonal_, g, g);
    return H_.from_tree(block_gmres(scaled_system(), preconditioner(), std::move(g), gmres_, summary, progress_));
  }

  /// H + B B^T
  BlockOperator system() const {
    return [this, work = typename CompressedMatrix<T>::Block(), s = VectorBlock()](const VectorBlock& in,
                                                                                   VectorBlock& out) mutable {
      if (curvature_) {
        curvature_->multiply(in, s);
        H_.multiply(in + s, out, work);
        curvature_->subtract_free_part(s, out);
      } else {
        H_.multiply(in, out, work);
      }
      add_product(B_, inner_products(B_, in), out);
    };
  }
  /// The same, each vertex's equations solved for its own displacement: where a block is close to singular, a small
  /// residual is a large error.
  BlockOperator scaled_system() const {
    return [this, A = system()](const VectorBlock& in, VectorBlock& out) {
      A(in, out);
      multiply_blocks(inverse_diagonal_, out, out);
    };
  }
  BlockOperator preconditioner() const {
    return [this, rest = VectorBlock(), local = VectorBlock()](const VectorBlock& in, VectorBlock& out) mutable {
      rest.resize(in.rows(), in.cols());
      multiply_blocks(H_.diagonal(), in, rest);
      coarse_.apply(rest, out);
      schwarz_.apply(rest, local);
      detail::for_each_chunk(out.rows(), [&](Index first, Index count) {
        out.middleRows(first, count) += local.middleRows(first, count);
      });
    };
  }
  /// out = blocks in, a block for each place; both may be the same. What fills up the last panel is zero.
  static void multiply_blocks(const std::vector<Mat3>& blocks, const VectorBlock& in, VectorBlock& out) {
    const Index places = Index(blocks.size()), step = Index(kPanel);  // between components
#pragma omp parallel for schedule(static)
    for (Index first = 0; first < places; first += step) {
      if (first + step > places) out.middleRows(3 * first, 3 * step) = in.middleRows(3 * first, 3 * step);
      for (Index place = first; place < std::min(places, first + step); ++place) {
        const Index row = tree_row(std::int32_t(place), 0, 3);
        for (Index c = 0; c < in.cols(); ++c) {
          const Vec3 product = blocks[place] * Vec3(in(row, c), in(row + step, c), in(row + 2 * step, c));
          for (int i = 0; i < 3; ++i) out(row + i * step, c) = product[i];
        }
      }
    }
  }

  CompressedMatrix<T> H_;
  SchwarzPreconditioner schwarz_;
  VectorBlock B_;  ///< in the tree's order
  CoarseCorrection coarse_;
  std::vector<Mat3> inverse_diagonal_;
  std::optional<TreeCurvature> curvature_;
  GmresOptions gmres_;
  Progress progress_;
};

}  // namespace

IterativeOptions IterativeOptions::for_tolerance(double tolerance, Index vertices) {
  IterativeOptions options;
  const double levels = std::pow(std::max(1.0, double(vertices) / 1e4), -0.25);  // of the tree, whose errors add up
  options.compression.tolerance = tolerance * levels / 7;
  options.compression.samples = tolerance >= 1e-4 ? 128 : tolerance >= 1e-5 ? 256 : 448;
  options.single = tolerance >= 2e-5;
  options.residual = std::min(1e-3, tolerance);
  options.compression.packed = tolerance >= 1e-4 && vertices > 8000;  // below, memory is no concern
  return options;
}

std::unique_ptr<NeumannSolver> make_iterative_solver(const TriangleMesh& mesh,
                                                     const Collocation<Kelvin<double>>& collocation,
                                                     const Eigen::MatrixXd& B, const IterativeOptions& options,
                                                     const Progress& progress, SharedCurvature curvature) {
  if (options.single) {
    return std::make_unique<CompressedSolver<float>>(mesh, collocation, B, options, progress, curvature);
  }
  return std::make_unique<CompressedSolver<double>>(mesh, collocation, B, options, progress, curvature);
}

}  // namespace skinbem
