// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// How far the response is led astray where H is compressed.
#pragma once

#include <cstdint>
#include <vector>

#include <skinbem/hmatrix/exact_rows.hpp>

namespace skinbem {

/// Different numbers below weights.size(), drawn with probabilities in proportion to the weights; the same for the same
/// weights; all where there are fewer than `count`.
std::vector<std::int32_t> draw_by_weight(std::vector<double> weights, std::size_t count);

/// What compression leaves of the equations (H + B B^T) Y = G, seen at a few vertices without compression. They are
/// drawn where the body moves most when its equations have random defects: what is wrong there is what matters.
class CompressionDefects {
 public:
  /// `answers` (3N by some): what solves for NeumannSolver::random_defects. B: rigid_modes.
  CompressionDefects(const Collocation<Kelvin<double>>& collocation, const Eigen::MatrixXd& B, Eigen::MatrixXd answers);

  const Eigen::MatrixXd& answers() const { return answers_; }
  /// Those of the same body compressed anew. The vertices stay: defects before and after are comparable.
  void set_answers(Eigen::MatrixXd answers) { answers_ = std::move(answers); }
  /// What is left of the vertices' equations, each solved for the vertex's own displacement: 3 #vertices by #columns,
  /// in the unit of Y. L = B^T Y.
  Eigen::MatrixXd of(const Eigen::MatrixXd& Y, const Eigen::MatrixXd& L, const Eigen::MatrixXd& G) const;
  /// The share of these that compression has in them, whose H V is `HV`; the rest is the iteration's.
  Eigen::MatrixXd of_compression(const Eigen::MatrixXd& V, const Eigen::MatrixXd& HV) const;

  /// The largest root mean square of a column of such defects. A vertex counts at most as three times their median: one
  /// in a steep place, beside a landmark, is no measure of the others.
  static double size(const Eigen::MatrixXd& defects);

 private:
  /// Each vertex's equations solved for its own displacement.
  Eigen::MatrixXd as_displacements(Eigen::MatrixXd left) const;

  Eigen::MatrixXd answers_;
  ExactRows rows_;
  Eigen::MatrixXd B_rows_;  ///< those rows of B
};

}  // namespace skinbem
