// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/solve/schwarz.hpp>

#include <algorithm>
#include <atomic>
#include <numeric>

#include <skinbem/base/lapack.hpp>
#include <skinbem/mesh/adjacency.hpp>
#include <skinbem/mesh/vertex_normals.hpp>

namespace skinbem {
namespace {

constexpr int components = 3;
constexpr double overlap_in_edges = 2;
constexpr std::size_t most_places = 128;  ///< of a leaf and its surroundings

/// Finds what is around a leaf.
class Surroundings {
 public:
  Surroundings(const TriangleMesh& mesh, const ClusterTree& tree, const BlockPartition& partition)
      : tree_(tree), partition_(partition), edge_(mesh_edges(mesh)) {
    const Points normals = vertex_normals(mesh);
    for (const std::int32_t v : tree.order()) {
      vertices_.push_back(mesh.vertices.row(v).transpose());
      normals_.push_back(normals.row(v).transpose());
    }
  }

  /// Places of the leaf, then those around it, nearest first.
  std::vector<std::int32_t> operator()(std::int32_t leaf) const {
    const Cluster& cluster = tree_.clusters()[leaf];
    struct Candidate {
      double distance;
      std::int32_t place;
      auto operator<=>(const Candidate&) const = default;
    };
    std::vector<Candidate> candidates;
    double thickness = std::numeric_limits<double>::infinity();
    for (const std::int32_t neighbour : partition_.near[leaf]) {
      if (neighbour == leaf) continue;
      const Cluster& other = tree_.clusters()[neighbour];
      for (std::int32_t k = other.begin; k < other.end; ++k) {
        double nearest2 = std::numeric_limits<double>::infinity();
        for (std::int32_t own = cluster.begin; own < cluster.end; ++own) {
          const Eigen::Vector3d d = vertices_[k] - vertices_[own];
          const double distance2 = d.squaredNorm();
          nearest2 = std::min(nearest2, distance2);
          const bool opposite = normals_[k].dot(normals_[own]) < -0.5 && d.dot(normals_[own]) < 0;
          if (opposite) thickness = std::min(thickness, std::sqrt(distance2));
        }
        candidates.push_back({std::sqrt(nearest2), k});
      }
    }
    const bool thin = thickness < cluster.points.diagonal().norm();
    const double edge = mean_edge(cluster);
    const double reach = std::max(overlap_in_edges * edge, thin ? thickness + edge : 0.0);
    std::sort(candidates.begin(), candidates.end());
    std::vector<std::int32_t> places(cluster.size());
    std::iota(places.begin(), places.end(), cluster.begin);
    for (const Candidate& candidate : candidates) {
      if (candidate.distance > reach || places.size() >= most_places) break;
      places.push_back(candidate.place);
    }
    std::sort(places.begin() + cluster.size(), places.end());
    return places;
  }

 private:
  /// Mean length of the edges at each vertex.
  static std::vector<double> mesh_edges(const TriangleMesh& mesh) {
    const IndexLists neighbours = neighbours_of_vertices(mesh);
    std::vector<double> lengths(mesh.vertex_count());
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      for (const std::int32_t w : neighbours[v]) {
        lengths[v] += (mesh.vertices.row(v) - mesh.vertices.row(w)).norm() / double(neighbours[v].size());
      }
    }
    return lengths;
  }
  double mean_edge(const Cluster& cluster) const {
    double sum = 0;
    for (std::int32_t k = cluster.begin; k < cluster.end; ++k) sum += edge_[tree_.order()[k]];
    return sum / cluster.size();
  }

  const ClusterTree& tree_;
  const BlockPartition& partition_;
  std::vector<double> edge_;
  std::vector<Eigen::Vector3d> vertices_, normals_;
};

/// Those that belong to the vertices at these places.
Eigen::MatrixXf rows_of(const Eigen::MatrixXd& B, const ClusterTree& tree, const std::vector<std::int32_t>& places) {
  Eigen::MatrixXf rows(components * Index(places.size()), B.cols());
  for (Index k = 0; k < Index(places.size()); ++k) {
    rows.middleRows<components>(components * k) =
        B.middleRows<components>(components * Index(tree.order()[places[k]])).cast<float>();
  }
  return rows;
}

/// The first `own` rows of A^-1, transposed: [A11 A12; A21 A22]^-T [I; 0] by elimination of the others, which takes two
/// thirds of what a factorisation of all does. False where it is singular.
bool first_rows_of_inverse(const Eigen::MatrixXf& A, Index own, Eigen::MatrixXf& rows) {
  const Index others = A.rows() - own;
  Eigen::MatrixXf A22 = A.bottomRightCorner(others, others), V = A.topRightCorner(own, others).transpose();
  if (others > 0 && !lapack::solve_transposed(A22, V)) return false;
  Eigen::MatrixXf complement = A.topLeftCorner(own, own);
  lapack::subtract_product('T', V, A.bottomLeftCorner(others, own), complement);
  Eigen::MatrixXf top = Eigen::MatrixXf::Identity(own, own);
  if (!lapack::solve_transposed(complement, top)) return false;
  rows.setZero(A.rows(), own);
  rows.topRows(own) = top;
  lapack::subtract_product('N', V, top, rows.bottomRows(others));
  return true;
}

}  // namespace

template <class T>
SchwarzPreconditioner::SchwarzPreconditioner(const TriangleMesh& mesh, const CompressedMatrix<T>& H,
                                             const Eigen::MatrixXd& B) {
  const ClusterTree& tree = H.tree();
  const Surroundings surroundings(mesh, tree, H.partition());
  leaves_.resize(tree.leaves().size());
  std::atomic<bool> singular = false;
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t k = 0; k < leaves_.size(); ++k) {
    const std::vector<std::int32_t> places = surroundings(tree.leaves()[k]);
    const Cluster& cluster = tree.clusters()[tree.leaves()[k]];
    Eigen::MatrixXf entries = H.near_entries(places);
    const Eigen::MatrixXf rigid = rows_of(B, tree, places);
    entries.noalias() += rigid * rigid.transpose();  // a small body is all around its leaves
    if (!invert(entries, cluster, places, leaves_[k])) singular = true;
  }
  if (singular) {
    throw Error(ErrorCode::numerical, "the equations around some vertices are singular; check the mesh there");
  }
}

bool SchwarzPreconditioner::invert(const Eigen::MatrixXf& entries, const Cluster& cluster,
                                   const std::vector<std::int32_t>& places, Leaf& leaf) {
  const int n = static_cast<int>(entries.rows()), own = cluster.size() * components;
  Eigen::MatrixXf rows;
  if (!first_rows_of_inverse(entries, own, rows)) return false;
  const Index panels = (cluster.size() + Index(kPanel) - 1) / Index(kPanel);
  leaf.first = tree_row(cluster.begin, 0, components);
  for (const std::int32_t place : places) {
    for (int i = 0; i < components; ++i) leaf.sources.push_back(tree_row(place, i, components));
  }
  leaf.inverse = PackedTiles(static_cast<std::size_t>(panels), leaf.sources.size());
  for (Index panel = 0; panel < panels; ++panel) {
    const Index first = panel * Index(kPanel), count = std::min(Index(kPanel), cluster.size() - first);
    for (Index k = 0; k < n; ++k) {
      float column[kTile] = {};
      for (Index p = 0; p < count; ++p) {
        for (int i = 0; i < components; ++i) column[i * Index(kPanel) + p] = rows(k, components * (first + p) + i);
      }
      leaf.inverse.set_column(static_cast<std::size_t>(panel), static_cast<std::size_t>(k), column);
    }
  }
  return true;
}

void SchwarzPreconditioner::apply(const VectorBlock& in, VectorBlock& out) const {
  out.resize(in.rows(), in.cols());
  const std::size_t columns = static_cast<std::size_t>(in.cols());
#pragma omp parallel
  {
    BlockRows<float>::Block gathered, result(Index(kTile), in.cols());
#pragma omp for schedule(dynamic, 4)
    for (std::size_t k = 0; k < leaves_.size(); ++k) {
      const Leaf& leaf = leaves_[k];
      gathered.resize(Index(leaf.sources.size()), in.cols());
      for (std::size_t s = 0; s < leaf.sources.size(); ++s) {
        gathered.row(Index(s)) = in.row(leaf.sources[s]).cast<float>();
      }
      for (std::size_t tile = 0; tile < leaf.inverse.size(); ++tile) {
        leaf.inverse.multiply(tile, gathered.data(), columns, result.data());
        out.middleRows(leaf.first + Index(tile * kTile), Index(kTile)) = result.cast<double>();
      }
    }
  }
}

std::size_t SchwarzPreconditioner::bytes() const {
  std::size_t sum = 0;
  for (const Leaf& leaf : leaves_) sum += leaf.inverse.bytes() + leaf.sources.size() * sizeof(Index);
  return sum;
}

template SchwarzPreconditioner::SchwarzPreconditioner(const TriangleMesh&, const CompressedMatrix<float>&,
                                                      const Eigen::MatrixXd&);
template SchwarzPreconditioner::SchwarzPreconditioner(const TriangleMesh&, const CompressedMatrix<double>&,
                                                      const Eigen::MatrixXd&);

}  // namespace skinbem
