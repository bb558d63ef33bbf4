// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/response/interpolation.hpp>

#include <omp.h>

#include <Eigen/CholmodSupport>
#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <utility>
#include <vector>

#include <skinbem/mesh/closest_point.hpp>

namespace skinbem {
namespace {

// Four unknowns a vertex: the value and the three components of its gradient, lengths in mean edges.
constexpr Index kUnknowns = 4;
using Sparse = Eigen::SparseMatrix<double, Eigen::ColMajor, SuiteSparse_long>;
using Triplet = Eigen::Triplet<double, SuiteSparse_long>;

/// Weight of a coarse vertex against bending: it is met to about 1e-4 of what the field would otherwise bend by.
constexpr double kBeta = 1e4;
/// Least weight of an edge: keeps the matrix definite over obtuse and degenerate triangles.
constexpr double kLeastWeight = 0.05;
constexpr double kMostWeight = 20;
/// Share of the diagonal beyond which a coarse vertex does not belong to the fine skin.
constexpr double kSameBody = 0.05;
/// Largest error of an affine field, relative to the diagonal, that passes.
constexpr double kReproduction = 1e-9;
/// Columns solved at once: bounds the memory.
constexpr Index kBatch = 48;

/// The value at a coarse vertex as a combination of the unknowns of three fine vertices.
struct Tie {
  std::array<Index, 3> vertices;
  Eigen::Matrix<double, 3 * kUnknowns, 1> factors;
};

/// Fronts of a surface are small: threads inside CHOLMOD's dense kernels only get in each other's way.
class OneThread {
 public:
  OneThread() : before_(omp_get_max_threads()) { omp_set_num_threads(1); }
  ~OneThread() { omp_set_num_threads(before_); }
  OneThread(const OneThread&) = delete;
  OneThread& operator=(const OneThread&) = delete;

 private:
  int before_;
};

double mean_edge(const TriangleMesh& mesh) {
  double sum = 0;
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    for (int c = 0; c < 3; ++c) sum += (mesh.corner(t, (c + 1) % 3) - mesh.corner(t, c)).norm();
  }
  return sum / static_cast<double>(3 * mesh.triangle_count());
}

/// Adds the lower triangle of a form in the unknowns of `vertices`.
template <std::size_t kCount>
void add_form(std::vector<Triplet>& matrix, const std::array<Index, kCount>& vertices,
              const Eigen::Matrix<double, kUnknowns * kCount, kUnknowns * kCount>& form) {
  const auto row_of = [&](Index i) {
    return kUnknowns * vertices[static_cast<std::size_t>(i / kUnknowns)] + i % kUnknowns;
  };
  for (Index j = 0; j < form.cols(); ++j) {
    for (Index i = 0; i < form.rows(); ++i) {
      if (row_of(i) >= row_of(j)) matrix.emplace_back(row_of(i), row_of(j), form(i, j));
    }
  }
}

struct Edge {
  Index from;
  Index to;  // > from
  double weight;
};

/// The edges with their cotangent weights, half the cotangent of each opposite angle, kept positive.
std::vector<Edge> weighted_edges(const TriangleMesh& mesh) {
  std::vector<Edge> halves;
  halves.reserve(static_cast<std::size_t>(3 * mesh.triangle_count()));
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    for (int c = 0; c < 3; ++c) {
      const Index a = mesh.triangles(t, c);
      const Index b = mesh.triangles(t, (c + 1) % 3);
      const Vec3 first = mesh.corner(t, c) - mesh.corner(t, (c + 2) % 3);
      const Vec3 second = mesh.corner(t, (c + 1) % 3) - mesh.corner(t, (c + 2) % 3);
      const double cotangent = first.dot(second) / first.cross(second).norm();
      halves.push_back({std::min(a, b), std::max(a, b), std::isfinite(cotangent) ? 0.5 * cotangent : 0});
    }
  }
  std::sort(halves.begin(), halves.end(),
            [](const Edge& p, const Edge& q) { return std::pair(p.from, p.to) < std::pair(q.from, q.to); });
  std::vector<Edge> edges;
  for (const Edge& half : halves) {
    if (edges.empty() || edges.back().from != half.from || edges.back().to != half.to)
      edges.push_back({half.from, half.to, 0});
    edges.back().weight += half.weight;
  }
  for (Edge& edge : edges) edge.weight = std::clamp(edge.weight, kLeastWeight, kMostWeight);
  return edges;
}

/// The bending energy of an edge as a form in (u_i, g_i, u_j, g_j); `direction` = x_j - x_i in mean edges.
Eigen::Matrix<double, 8, 8> edge_energy(const Vec3& direction, double weight) {
  Eigen::Matrix<double, 8, 1> deviation;
  deviation << -1, -0.5 * direction, 1, -0.5 * direction;
  Eigen::Matrix<double, 8, 8> energy = 12 * weight / direction.squaredNorm() * deviation * deviation.transpose();
  energy.block<3, 3>(1, 1).diagonal().array() += weight;
  energy.block<3, 3>(5, 5).diagonal().array() += weight;
  energy.block<3, 3>(5, 1).diagonal().array() -= weight;
  energy.block<3, 3>(1, 5).diagonal().array() -= weight;
  return energy;
}

Sparse system_matrix(const TriangleMesh& fine, const std::vector<Tie>& ties, double length) {
  std::vector<Triplet> triplets;
  for (const Edge& edge : weighted_edges(fine)) {
    const Vec3 direction = (fine.vertices.row(edge.to) - fine.vertices.row(edge.from)).transpose() / length;
    if (direction.squaredNorm() > 0) add_form<2>(triplets, {edge.from, edge.to}, edge_energy(direction, edge.weight));
  }
  for (const Tie& tie : ties) add_form<3>(triplets, tie.vertices, kBeta * tie.factors * tie.factors.transpose());
  const Index size = kUnknowns * fine.vertex_count();
  Sparse matrix(size, size);
  matrix.setFromTriplets(triplets.begin(), triplets.end());
  return matrix;
}

Tie tie_at(const Vec3& point, const SurfacePoint& nearest, const TriangleMesh& fine, double length) {
  Tie tie;
  for (int c = 0; c < 3; ++c) {
    tie.vertices[static_cast<std::size_t>(c)] = fine.triangles(nearest.triangle, c);
    tie.factors.segment<kUnknowns>(kUnknowns * c) << nearest.barycentric(c),
        nearest.barycentric(c) / length * (point - fine.corner(nearest.triangle, c));
  }
  return tie;
}

}  // namespace

struct SkinInterpolation::Factor {
  Index fine_count = 0;
  double largest_distance = 0;
  std::vector<Tie> ties;  // one a coarse vertex
  // CHOLMOD's workspace is part of the solver, so that solving is not const.
  mutable Eigen::CholmodSupernodalLLT<Sparse, Eigen::Lower> solver;
};

SkinInterpolation::SkinInterpolation(const Points& coarse, const TriangleMesh& fine, const Progress& progress)
    : factor_(std::make_unique<Factor>()) {
  if (coarse.rows() == 0 || fine.triangle_count() == 0) {
    throw Error(ErrorCode::usage, "interpolation: both skins need vertices");
  }
  factor_->fine_count = fine.vertex_count();
  const double length = mean_edge(fine);
  const SurfaceQuery surface(fine);
  for (Index c = 0; c < coarse.rows(); ++c) {
    const Vec3 point = coarse.row(c);
    const SurfacePoint nearest = surface.closest(point);
    const double distance = nearest.distance;
    if (!(distance <= kSameBody * diagonal(fine))) {
      throw Error(ErrorCode::bad_input, "interpolation: vertex " + std::to_string(c) + " of the coarse skin is " +
                                            std::to_string(distance) +
                                            " away from the fine skin; both must be one body in one place and unit");
    }
    factor_->largest_distance = std::max(factor_->largest_distance, distance);
    factor_->ties.push_back(tie_at(point, nearest, fine, length));
  }
  report(progress, "interpolation: factorise", 0);
  const OneThread guard;
  factor_->solver.cholmod().print = 0;  // errors are ours to tell
  factor_->solver.compute(system_matrix(fine, factor_->ties, length));
  check_reproduction(coarse, fine);
}

// The coordinates themselves are an affine field: they come back unless the system is singular or nearly so, which a
// Cholesky factorisation alone does not always notice.
void SkinInterpolation::check_reproduction(const Points& coarse, const TriangleMesh& fine) const {
  bool good = factor_->solver.info() == Eigen::Success;
  if (good) {
    const Vec3 centre = fine.vertices.colwise().mean();
    const Points offset = coarse.rowwise() - centre.transpose();
    const Eigen::VectorXd found = apply(Eigen::Map<const Eigen::VectorXd>(offset.data(), offset.size()));
    const Points difference =
        Eigen::Map<const Points>(found.data(), fine.vertex_count(), 3) - (fine.vertices.rowwise() - centre.transpose());
    good = (difference.array().abs() <= kReproduction * diagonal(fine)).all();  // false for NaN
  }
  if (!good) {
    throw Error(
        ErrorCode::numerical,
        "interpolation: the coarse vertices leave the fine skin undetermined; they must not lie in one plane, and "
        "every piece of the fine skin needs four or more");
  }
}

SkinInterpolation::~SkinInterpolation() = default;
SkinInterpolation::SkinInterpolation(SkinInterpolation&&) noexcept = default;
SkinInterpolation& SkinInterpolation::operator=(SkinInterpolation&&) noexcept = default;

Eigen::MatrixXd SkinInterpolation::apply(const Eigen::MatrixXd& response, const Progress& progress) const {
  const Index coarse_count = static_cast<Index>(factor_->ties.size());
  if (response.rows() != 3 * coarse_count) {
    throw Error(ErrorCode::usage, "interpolation: a response of " + std::to_string(response.rows()) +
                                      " rows does not belong to " + std::to_string(coarse_count) + " coarse vertices");
  }
  const OneThread guard;
  Eigen::MatrixXd result(3 * factor_->fine_count, response.cols());
  // Column 3 j + c of a batch is component c of column j of the response.
  for (Index begin = 0; begin < response.cols(); begin += kBatch / 3) {
    report(progress, "interpolation: solve", static_cast<double>(begin) / static_cast<double>(response.cols()));
    const Index count = std::min(kBatch / 3, response.cols() - begin);
    Eigen::MatrixXd load = Eigen::MatrixXd::Zero(kUnknowns * factor_->fine_count, 3 * count);
    for (Index i = 0; i < coarse_count; ++i) {
      const Tie& tie = factor_->ties[static_cast<std::size_t>(i)];
      const Eigen::Matrix<double, 3, Eigen::Dynamic> values = response.block(3 * i, begin, 3, count);
      for (std::size_t a = 0; a < 3; ++a) {
        load.middleRows<kUnknowns>(kUnknowns * tie.vertices[a]) +=
            kBeta * tie.factors.segment<kUnknowns>(kUnknowns * static_cast<Index>(a)) * values.reshaped().transpose();
      }
    }
    const Eigen::MatrixXd solution = factor_->solver.solve(load);
    for (Index v = 0; v < factor_->fine_count; ++v) {
      result.block(3 * v, begin, 3, count).reshaped() = solution.row(kUnknowns * v).transpose();
    }
  }
  return result;
}

double SkinInterpolation::largest_distance() const noexcept { return factor_->largest_distance; }

}  // namespace skinbem
