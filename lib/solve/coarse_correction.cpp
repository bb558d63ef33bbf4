// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/solve/coarse_correction.hpp>

#include <algorithm>

#include <skinbem/base/error.hpp>
#include <skinbem/solve/rigid_modes.hpp>

namespace skinbem {
namespace {

constexpr int components = 3;

/// The largest cluster is halved until there are so many.
std::vector<std::int32_t> clusters_of_parts(const ClusterTree& tree, std::size_t parts) {
  const auto& clusters = tree.clusters();
  std::vector<std::int32_t> chosen = {0};
  const auto smaller = [&](auto a, auto b) { return clusters[a].size() < clusters[b].size(); };
  while (chosen.size() < parts) {
    const auto largest = std::max_element(chosen.begin(), chosen.end(), smaller);
    const Cluster& cluster = clusters[*largest];
    if (cluster.is_leaf()) break;
    *largest = cluster.children[0];
    chosen.push_back(cluster.children[1]);
  }
  std::sort(chosen.begin(), chosen.end(), [&](auto a, auto b) { return clusters[a].begin < clusters[b].begin; });
  return chosen;
}

/// Rigid motions of a cluster's vertices in the tree's order.
VectorBlock motions(const TriangleMesh& mesh, const ClusterTree& tree, const Cluster& cluster) {
  Points points(cluster.size(), 3);
  for (Index v = 0; v < points.rows(); ++v) points.row(v) = mesh.vertices.row(tree.order()[cluster.begin + v]);
  const Eigen::MatrixXd B = rigid_modes(points);
  const Index panels = (cluster.size() + Index(kPanel) - 1) / Index(kPanel);
  VectorBlock Z = VectorBlock::Zero(panels * Index(kPanel) * components, B.cols());
  for (Index v = 0; v < points.rows(); ++v) {
    for (int i = 0; i < components; ++i) Z.row(tree_row(v, i, components)) = B.row(components * v + i);
  }
  return Z;
}

}  // namespace

CoarseCorrection::CoarseCorrection(const TriangleMesh& mesh, const ClusterTree& tree, Index rows,
                                   const BlockOperator& A, std::size_t parts) {
  for (const std::int32_t c : clusters_of_parts(tree, parts)) {
    const Cluster& cluster = tree.clusters()[c];
    parts_.push_back({tree_row(cluster.begin, 0, components), motions(mesh, tree, cluster)});
  }
  VectorBlock Z = VectorBlock::Zero(rows, width());
  prolong(Eigen::MatrixXd::Identity(width(), width()), Z);
  A(Z, AZ_);
  E_.compute(restrict_to_parts(AZ_));
  if (!(E_.rcond() > 1e-14)) {
    throw Error(ErrorCode::numerical, "parts of the body move freely against each other; check the mesh");
  }
}

Eigen::MatrixXd CoarseCorrection::restrict_to_parts(const VectorBlock& V) const {
  Eigen::MatrixXd S(width(), V.cols());
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const VectorBlock& Z = parts_[k].Z;
    S.middleRows<6>(6 * Index(k)) = Z.transpose() * V.middleRows(parts_[k].first, Z.rows());
  }
  return S;
}

void CoarseCorrection::prolong(const Eigen::MatrixXd& S, VectorBlock& V) const {
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const VectorBlock& Z = parts_[k].Z;
    V.middleRows(parts_[k].first, Z.rows()) = Z * S.middleRows<6>(6 * Index(k));
  }
}

void CoarseCorrection::apply(VectorBlock& in, VectorBlock& out) const {
  const Eigen::MatrixXd S = E_.solve(restrict_to_parts(in));
  out.resize(in.rows(), in.cols());
  prolong(S, out);
  add_product(AZ_, -S, in);
}

}  // namespace skinbem
