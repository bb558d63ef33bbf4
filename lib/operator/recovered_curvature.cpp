// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/operator/recovered_curvature.hpp>

#include <Eigen/Geometry>
#include <algorithm>

#include <skinbem/operator/free_term.hpp>

namespace skinbem {
namespace {

template <class Value>
void add_to(std::vector<Indexed<Value>>& list, std::int32_t index, const Value& value) {
  const auto found = std::find_if(list.begin(), list.end(), [&](const auto& item) { return item.index == index; });
  if (found == list.end()) {
    list.push_back({index, value});
  } else {
    found->value += value;
  }
}

TriangleMesh scaled(TriangleMesh mesh, double scale) {
  mesh.vertices *= scale;
  return mesh;
}

}  // namespace

RecoveredCurvature::RecoveredCurvature(const TriangleMesh& mesh, double poisson)
    : mesh_(scaled(mesh, unit_scale(mesh))),
      scale_(unit_scale(mesh)),
      poisson_(poisson),
      triangles_of_vertex_(triangles_around_vertices(mesh_)),
      vertex_areas_(vertex_areas(mesh_)),
      free_terms_(skinbem::free_terms(mesh_, poisson)),
      S_(static_cast<std::size_t>(mesh.vertex_count())) {
#pragma omp parallel for schedule(dynamic, 64)
  for (Index k = 0; k < mesh_.vertex_count(); ++k) S_[static_cast<std::size_t>(k)] = row_of(k);
}

template <class Visit>
void RecoveredCurvature::for_each_gradient(Index vertex, const Visit& visit) const {
  const auto third = [&](std::int32_t t) { return area_vector(mesh_, t).norm() / 6; };
  std::vector<Indexed<Vec3>> directions;  // s is the sum over vertices of their gradient times such a direction
  for (const std::int32_t t : triangles_of_vertex_[vertex]) {
    const double weight = third(t) / (16 * vertex_areas_[vertex]);
    for (int c = 0; c < 3; ++c) {
      const std::int32_t other = mesh_.triangles(t, c);
      if (other == vertex) continue;
      const Vec3 along = weight * (mesh_.vertices.row(other) - mesh_.vertices.row(vertex));
      add_to(directions, static_cast<std::int32_t>(vertex), along);
      add_to<Vec3>(directions, other, -along);
    }
  }
  for (const auto& [other, along] : directions) {
    for (const std::int32_t t : triangles_of_vertex_[other]) {
      visit(t, area_vector(mesh_, t).normalized(), Vec3(third(t) / vertex_areas_[other] * along));
    }
  }
}

SparseBlockRow RecoveredCurvature::row_of(Index vertex) const {
  const double thinning = poisson_ / (1 - poisson_);  // strain across the surface for strain within it, no traction
  SparseBlockRow row;
  for_each_gradient(vertex, [&](std::int32_t t, const Vec3& n, const Vec3& d) {
    const double twice_area = area_vector(mesh_, t).norm(), across = n.dot(d);
    for (int c = 0; c < 3; ++c) {
      const Vec3 side = mesh_.corner(t, (c + 2) % 3) - mesh_.corner(t, (c + 1) % 3);
      const Vec3 g = n.cross(side) / twice_area;  // gradient of the corner's hat function
      const Mat3 block = g.dot(d) * Mat3::Identity() - across * (g * n.transpose() + thinning * n * g.transpose());
      add_to(row, mesh_.triangles(t, c), block);
    }
  });
  return row;
}

Eigen::MatrixXd RecoveredCurvature::of_displacements(const Eigen::MatrixXd& V) const {
  Eigen::MatrixXd s = Eigen::MatrixXd::Zero(V.rows(), V.cols());
#pragma omp parallel for schedule(static)
  for (Index k = 0; k < mesh_.vertex_count(); ++k) {
    for (const auto& [column, block] : S_[static_cast<std::size_t>(k)]) {
      s.middleRows<3>(3 * k) += block.lazyProduct(V.middleRows<3>(3 * Index(column)));
    }
  }
  return s;
}

Eigen::VectorXd RecoveredCurvature::of_tractions(const Points& tractions) const {
  const double softness = (1 - 2 * poisson_) / (2 * (1 - poisson_));  // of strain across the surface, against shear
  std::vector<char> loaded(S_.size(), 0);                             // at a corner of a triangle with a traction
  for (Index t = 0; t < mesh_.triangle_count(); ++t) {
    if (tractions.row(t).isZero(0)) continue;
    for (int c = 0; c < 3; ++c) loaded[mesh_.triangles(t, c)] = 1;
  }
  Eigen::VectorXd s = Eigen::VectorXd::Zero(3 * mesh_.vertex_count());
#pragma omp parallel for schedule(dynamic, 64)
  for (Index k = 0; k < mesh_.vertex_count(); ++k) {
    const auto& around = triangles_of_vertex_[k];
    const bool reached = std::any_of(around.begin(), around.end(), [&](std::int32_t t) {
      return loaded[mesh_.triangles(t, 0)] || loaded[mesh_.triangles(t, 1)] || loaded[mesh_.triangles(t, 2)];
    });
    if (!reached) continue;
    for_each_gradient(k, [&](std::int32_t t, const Vec3& n, const Vec3& d) {
      const Vec3 traction = tractions.row(t);
      s.segment<3>(3 * k) += n.dot(d) / scale_ * (traction - (1 - softness) * n.dot(traction) * n);
    });
  }
  return s;
}

Eigen::MatrixXd RecoveredCurvature::of_tractions(std::span<const LoadedPiece> density) const {
  Eigen::VectorXd mean = loads_of_triangles(mesh_, density);
  for (Index t = 0; t < mean.size(); ++t) mean[t] /= area_vector(mesh_, t).norm() / 2;
  Eigen::MatrixXd s(3 * mesh_.vertex_count(), 3);
  for (int i = 0; i < 3; ++i) s.col(i) = of_tractions(Points(mean * Vec3::Unit(i).transpose()));
  return s;
}

Eigen::MatrixXd RecoveredCurvature::free_part(const Eigen::MatrixXd& V) const {
  Eigen::MatrixXd result(V.rows(), V.cols());
  for (Index k = 0; k < mesh_.vertex_count(); ++k) {
    result.middleRows<3>(3 * k) = free_terms_[static_cast<std::size_t>(k)] * V.middleRows<3>(3 * k);
  }
  return result;
}

}  // namespace skinbem
