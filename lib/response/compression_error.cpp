// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/response/compression_error.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>

namespace skinbem {
namespace {

constexpr std::size_t sampled_vertices = 16;

/// By vertex, the size of the motion that is not rigid, to a power between those that miss a few loose vertices and
/// those that see nothing else.
std::vector<double> how_loose(const Eigen::MatrixXd& B, const Eigen::MatrixXd& answers) {
  constexpr double power = 1.5;
  const Eigen::MatrixXd bent = answers - B * (B.transpose() * answers);
  std::vector<double> sizes(static_cast<std::size_t>(bent.rows()) / 3);
  for (std::size_t v = 0; v < sizes.size(); ++v) sizes[v] = std::pow(bent.middleRows<3>(3 * Index(v)).norm(), power);
  return sizes;
}

}  // namespace

std::vector<std::int32_t> draw_by_weight(std::vector<double> weights, std::size_t count) {
  std::mt19937 generator(1);
  std::vector<double> sums(weights.size());
  std::vector<std::int32_t> drawn;
  while (drawn.size() < std::min(count, weights.size())) {
    std::partial_sum(weights.begin(), weights.end(), sums.begin());
    const double at = double(generator()) / (double(generator.max()) + 1) * sums.back();
    const std::size_t found = std::size_t(std::upper_bound(sums.begin(), sums.end(), at) - sums.begin());
    if (found == sums.size()) break;  // nothing is left that weighs anything
    drawn.push_back(std::int32_t(found));
    weights[found] = 0;
  }
  return drawn;
}

CompressionDefects::CompressionDefects(const Collocation<Kelvin<double>>& collocation, const Eigen::MatrixXd& B,
                                       Eigen::MatrixXd answers)
    : answers_(std::move(answers)),
      rows_(collocation, draw_by_weight(how_loose(B, answers_), sampled_vertices)),
      B_rows_(rows_.pick(B)) {}

Eigen::MatrixXd CompressionDefects::of(const Eigen::MatrixXd& Y, const Eigen::MatrixXd& L,
                                       const Eigen::MatrixXd& G) const {
  return as_displacements(rows_.multiply(Y) + B_rows_ * L - rows_.pick(G));
}

Eigen::MatrixXd CompressionDefects::of_compression(const Eigen::MatrixXd& V, const Eigen::MatrixXd& HV) const {
  return as_displacements(rows_.multiply(V) - rows_.pick(HV));
}

Eigen::MatrixXd CompressionDefects::as_displacements(Eigen::MatrixXd left) const {
  for (std::size_t k = 0; k < rows_.vertices().size(); ++k) {
    auto own = left.middleRows<3>(3 * Index(k));
    own = (rows_.own_block(k).inverse() * own).eval();
  }
  return left;
}

double CompressionDefects::size(const Eigen::MatrixXd& defects) {
  constexpr double most = 3;  // medians
  double largest = 0;
  std::vector<double> norms(static_cast<std::size_t>(defects.rows()) / 3);
  if (norms.empty()) return 0;  // every equation is exact
  for (Index c = 0; c < defects.cols(); ++c) {
    for (std::size_t k = 0; k < norms.size(); ++k) norms[k] = defects.col(c).segment<3>(3 * Index(k)).norm();
    const auto middle = norms.begin() + Index(norms.size() / 2);
    std::nth_element(norms.begin(), middle, norms.end());
    const double limit = most * *middle;
    const double squares = std::accumulate(norms.begin(), norms.end(), 0.0, [&](double sum, double norm) {
      return sum + std::pow(std::min(norm, limit), 2);
    });
    largest = std::max(largest, std::sqrt(squares / double(defects.rows())));
  }
  return largest;
}

}  // namespace skinbem
