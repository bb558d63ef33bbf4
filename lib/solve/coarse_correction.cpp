// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/solve/coarse_correction.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <skinbem/base/error.hpp>
#include <skinbem/base/lapack.hpp>
#include <skinbem/base/rigid_fit.hpp>
#include <skinbem/mesh/adjacency.hpp>
#include <skinbem/solve/rigid_modes.hpp>

namespace skinbem {
namespace {

constexpr int components = 3;

/// The part to which each vertex is nearest so far, and how many edges away; begin() adds one around `seed`.
struct Walk {
  std::vector<std::int32_t> part, edges;

  void begin(const IndexLists& neighbours, std::int32_t seed, std::int32_t number) {
    std::vector<std::int32_t> front = {seed};
    part[seed] = number;
    edges[seed] = 0;
    for (std::size_t k = 0; k < front.size(); ++k) {
      for (const std::int32_t next : neighbours[front[k]]) {
        if (edges[front[k]] + 1 >= edges[next]) continue;
        part[next] = number;
        edges[next] = edges[front[k]] + 1;
        front.push_back(next);
      }
    }
  }
};

}  // namespace

std::vector<std::vector<std::int32_t>> parts_of_skin(const TriangleMesh& mesh, std::size_t count) {
  const IndexLists neighbours = neighbours_of_vertices(mesh);
  const std::size_t vertices = static_cast<std::size_t>(mesh.vertex_count());
  Walk walk{std::vector<std::int32_t>(vertices), std::vector<std::int32_t>(vertices, std::numeric_limits<int>::max())};
  Index seed = 0;
  (mesh.vertices.rowwise() - mesh.vertices.colwise().mean().eval()).rowwise().squaredNorm().maxCoeff(&seed);
  std::vector<std::vector<std::int32_t>> parts;
  while (parts.size() < count && walk.edges[seed] > 0) {
    walk.begin(neighbours, std::int32_t(seed), std::int32_t(parts.size()));
    parts.emplace_back();
    seed = std::max_element(walk.edges.begin(), walk.edges.end()) - walk.edges.begin();
  }
  for (std::size_t v = 0; v < vertices; ++v) parts[walk.part[v]].push_back(std::int32_t(v));
  return parts;
}

std::size_t CoarseCorrection::parts_for(Index vertices) {
  constexpr double most = 64;
  return static_cast<std::size_t>(std::clamp(std::sqrt(double(vertices)) / 4, 1.0, most));
}

template <class T>
CoarseCorrection::CoarseCorrection(const TriangleMesh& mesh, const CompressedMatrix<T>& H, const VectorBlock& B,
                                   std::size_t parts) {
  std::vector<std::int32_t> places(H.tree().order().size());
  for (std::size_t place = 0; place < places.size(); ++place) places[H.tree().order()[place]] = std::int32_t(place);
  for (const auto& vertices : parts_of_skin(mesh, parts)) add_part(mesh, vertices, places);
  AZ_ = PackedTiles(static_cast<std::size_t>(H.rows()) / kTile, static_cast<std::size_t>(width()));
  Eigen::MatrixXd E(width(), width());
#pragma omp parallel
  {
    VectorBlock Z, AZ;
    typename CompressedMatrix<T>::Block work;
#pragma omp for schedule(dynamic, 1)
    for (std::size_t k = 0; k < parts_.size(); ++k) {
      Z.setZero(H.rows(), 6);
      for (std::size_t r = 0; r < parts_[k].rows.size(); ++r) Z.row(parts_[k].rows[r]) = parts_[k].Z.row(Index(r));
      H.multiply_sparse(Z, AZ, work);
      add_product(B, inner_products(B, Z), AZ);
      set_product(k, AZ);
      E.middleCols<6>(6 * Index(k)) = restrict_to_parts(AZ);
    }
  }
  E_.compute(E);
  if (!(E_.rcond() > 1e-14)) {
    throw Error(ErrorCode::numerical, "parts of the body move freely against each other; check the mesh");
  }
}

void CoarseCorrection::set_product(std::size_t k, const VectorBlock& AZ) {
  for (std::size_t tile = 0; tile < AZ_.size(); ++tile) {
    Eigen::Matrix<float, kTile, 6> columns = AZ.middleRows<kTile>(Index(tile * kTile)).cast<float>();
    for (Index c = 0; c < 6; ++c) AZ_.set_column(tile, 6 * k + std::size_t(c), columns.col(c).data());
  }
}

/// Too few vertices, or some on a line, have no motion that is theirs.
void CoarseCorrection::add_part(const TriangleMesh& mesh, const std::vector<std::int32_t>& vertices,
                                const std::vector<std::int32_t>& places) {
  constexpr std::size_t fewest = 16;
  Points points(Index(vertices.size()), 3);
  for (std::size_t k = 0; k < vertices.size(); ++k) points.row(Index(k)) = mesh.vertices.row(vertices[k]);
  if (vertices.size() < fewest || collinear_measure(points) < 1e-6) return;
  Part part{{}, rigid_modes(points)};
  for (const std::int32_t vertex : vertices) {
    for (int i = 0; i < components; ++i) part.rows.push_back(tree_row(places[vertex], i, components));
  }
  parts_.push_back(std::move(part));
}

Eigen::MatrixXd CoarseCorrection::restrict_to_parts(const VectorBlock& V) const {
  Eigen::MatrixXd S(width(), V.cols());
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const Part& part = parts_[k];
    VectorBlock gathered(part.Z.rows(), V.cols());
    for (Index r = 0; r < gathered.rows(); ++r) gathered.row(r) = V.row(part.rows[static_cast<std::size_t>(r)]);
    RowMajorMatrix product(6, V.cols());
    lapack::inner_product(part.Z.data(), gathered.data(), gathered.rows(), product);
    S.middleRows<6>(6 * Index(k)) = product;
  }
  return S;
}

void CoarseCorrection::prolong(const Eigen::MatrixXd& S, VectorBlock& V) const {
#pragma omp parallel for schedule(dynamic, 1)
  for (std::size_t k = 0; k < parts_.size(); ++k) {
    const Part& part = parts_[k];
    VectorBlock moved = VectorBlock::Zero(part.Z.rows(), S.cols());
    lapack::add_product(part.Z.data(), RowMajorMatrix(S.middleRows<6>(6 * Index(k))), moved.rows(), moved.data());
    for (Index r = 0; r < moved.rows(); ++r) V.row(part.rows[static_cast<std::size_t>(r)]) = moved.row(r);
  }
}

void CoarseCorrection::apply(VectorBlock& in, VectorBlock& out) const {
  const Eigen::MatrixXd S = E_.solve(restrict_to_parts(in));
  out.setZero(in.rows(), in.cols());
  prolong(S, out);
  const SingleRows taken = S.cast<float>();
#pragma omp parallel
  {
    SingleRows product(Index(kTile), in.cols());
#pragma omp for schedule(static)
    for (std::size_t tile = 0; tile < AZ_.size(); ++tile) {
      AZ_.multiply(tile, taken.data(), static_cast<std::size_t>(in.cols()), product.data());
      in.middleRows<kTile>(Index(tile * kTile)) -= product.cast<double>();
    }
  }
}

template CoarseCorrection::CoarseCorrection(const TriangleMesh&, const CompressedMatrix<float>&, const VectorBlock&,
                                            std::size_t);
template CoarseCorrection::CoarseCorrection(const TriangleMesh&, const CompressedMatrix<double>&, const VectorBlock&,
                                            std::size_t);

}  // namespace skinbem
