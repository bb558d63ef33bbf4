// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/response/landmark_patch.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

#include <skinbem/base/error.hpp>
#include <skinbem/mesh/closest_point.hpp>

namespace skinbem {
namespace {

/// phi(d / radius), 1 at the centre.
struct Spread {
  Vec3 centre;
  double radius;

  bool reaches(const Vec3& x) const { return (x - centre).norm() < radius; }
  double operator()(const Vec3& x) const {
    if (!reaches(x)) return x == centre ? 1 : 0;
    const double s = (x - centre).norm() / radius;
    return (1 - s * s) * (1 - s * s);
  }
};

/// The vertices that the patch reaches from its centre: from one over a triangle t around it to a corner v of that
/// where `on(t, v)`.
template <class Predicate>
std::vector<std::int32_t> reached_vertices(const TriangleMesh& mesh, const IndexLists& triangles_of_vertex,
                                           std::int32_t centre, const Predicate& on) {
  std::vector<std::int32_t> reached = {centre};
  std::vector<bool> seen(static_cast<std::size_t>(mesh.vertex_count()), false);
  seen[centre] = true;
  for (std::size_t next = 0; next < reached.size(); ++next) {
    for (const std::int32_t t : triangles_of_vertex[reached[next]]) {
      for (const std::int32_t v : mesh.triangles.row(t)) {
        if (seen[v] || !on(t, v)) continue;
        seen[v] = true;
        reached.push_back(v);
      }
    }
  }
  return reached;
}

/// The triangles around these vertices, each once.
std::vector<std::int32_t> triangles_around(const IndexLists& triangles_of_vertex,
                                           const std::vector<std::int32_t>& vertices) {
  std::vector<std::int32_t> triangles;
  for (const std::int32_t v : vertices) {
    triangles.insert(triangles.end(), triangles_of_vertex[v].begin(), triangles_of_vertex[v].end());
  }
  std::sort(triangles.begin(), triangles.end());
  triangles.erase(std::unique(triangles.begin(), triangles.end()), triangles.end());
  return triangles;
}

Vec3 place_on(const TriangleMesh& mesh, std::int32_t triangle, const Vec3& barycentric) {
  Vec3 place = Vec3::Zero();
  for (int c = 0; c < 3; ++c) place += barycentric[c] * mesh.corner(triangle, c);
  return place;
}

/// Quarters a part of a triangle until phi is close to linear on it; what phi does not reach is left out.
void cut(const TriangleMesh& mesh, std::int32_t triangle, const Mat3& corners, const Spread& phi,
         std::vector<LoadedPiece>& pieces) {
  constexpr double finest = 1.0 / 4;  // longest side, of the radius
  Mat3 x, halfway;                    // places of the corners; the middles of the sides opposite to them
  double longest = 0;
  for (int k = 0; k < 3; ++k) x.col(k) = place_on(mesh, triangle, corners.col(k));
  if (!phi.reaches(closest_point_of_triangle(x.col(0), x.col(1), x.col(2), phi.centre).position)) return;
  for (int k = 0; k < 3; ++k) {
    halfway.col(k) = (corners.col((k + 1) % 3) + corners.col((k + 2) % 3)) / 2;
    longest = std::max(longest, (x.col((k + 1) % 3) - x.col((k + 2) % 3)).norm());
  }
  if (longest <= finest * phi.radius) {
    pieces.push_back({triangle, corners, {phi(x.col(0)), phi(x.col(1)), phi(x.col(2))}});
    return;
  }
  cut(mesh, triangle, halfway, phi, pieces);
  for (int k = 0; k < 3; ++k) {
    Mat3 quarter;
    quarter << corners.col(k), halfway.col((k + 2) % 3), halfway.col((k + 1) % 3);
    cut(mesh, triangle, quarter, phi, pieces);
  }
}

double shortest_edge(const TriangleMesh& mesh, const IndexLists& triangles_of_vertex, std::int32_t vertex) {
  double shortest = std::numeric_limits<double>::infinity();
  for (const std::int32_t t : triangles_of_vertex[vertex]) {
    for (const std::int32_t v : mesh.triangles.row(t)) {
      if (v != vertex) shortest = std::min(shortest, (mesh.vertices.row(v) - mesh.vertices.row(vertex)).norm());
    }
  }
  return shortest;
}

std::vector<VertexWeight> of_sum_one(const Eigen::VectorXd& weights) {
  std::vector<VertexWeight> result;
  const double sum = weights.sum();
  for (Index v = 0; v < weights.size(); ++v) {
    if (weights[v] != 0) result.push_back({static_cast<std::int32_t>(v), weights[v] / sum});
  }
  return result;
}

/// Weights w_i for int phi u dS where sum_i w_i u_i is that for a u linear between the vertices: as u bows there, half
/// of what interpolating once more would do (M D^-1, the mass matrix over the areas) is taken back.
Eigen::VectorXd for_curved_fields(const TriangleMesh& mesh, const Eigen::VectorXd& vertex_areas,
                                  const Eigen::VectorXd& weights) {
  const Eigen::VectorXd density = weights.cwiseQuotient(vertex_areas);
  Eigen::VectorXd again = Eigen::VectorXd::Zero(weights.size());
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    const Vec3 corners = density(mesh.triangles.row(t));
    if (corners.isZero(0)) continue;
    again(mesh.triangles.row(t)) += area_vector(mesh, t).norm() / 24 * (Vec3::Constant(corners.sum()) + corners);
  }
  return weights + (weights - again) / 2;
}

LandmarkPatch linear_patch(const TriangleMesh& mesh, const IndexLists& triangles_of_vertex,
                           const Eigen::VectorXd& vertex_areas, std::int32_t centre, const Spread& phi) {
  const auto vertices = reached_vertices(mesh, triangles_of_vertex, centre, [&](std::int32_t, std::int32_t v) {
    return phi.reaches(mesh.vertices.row(v));
  });
  LandmarkPatch patch;
  for (const std::int32_t t : triangles_around(triangles_of_vertex, vertices)) {
    const Vec3 density(phi(mesh.corner(t, 0)), phi(mesh.corner(t, 1)), phi(mesh.corner(t, 2)));
    patch.traction.push_back({t, Mat3::Identity(), density});
  }
  Eigen::VectorXd weights = Eigen::VectorXd::Zero(mesh.vertex_count());
  for (const std::int32_t v : vertices) weights[v] = phi(mesh.vertices.row(v)) * vertex_areas[v];
  patch.measurement = of_sum_one(weights);
  return patch;
}

LandmarkPatch smooth_patch(const TriangleMesh& mesh, const IndexLists& triangles_of_vertex,
                           const Eigen::VectorXd& vertex_areas, std::int32_t centre, const Spread& phi) {
  const auto vertices = reached_vertices(mesh, triangles_of_vertex, centre, [&](std::int32_t t, std::int32_t) {
    return phi.reaches(
        closest_point_of_triangle(mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2), phi.centre).position);
  });
  LandmarkPatch patch;
  for (const std::int32_t t : triangles_around(triangles_of_vertex, vertices)) {
    cut(mesh, t, Mat3::Identity(), phi, patch.traction);
  }
  patch.measurement = of_sum_one(for_curved_fields(mesh, vertex_areas, loads_of_vertices(mesh, patch.traction)));
  return patch;
}

}  // namespace

Vec3 LandmarkPatch::measure(const Eigen::Ref<const Points>& field) const {
  Vec3 sum = Vec3::Zero();
  for (const VertexWeight& w : measurement) sum += w.value * field.row(w.vertex).transpose();
  return sum;
}

LandmarkPatch make_patch(const TriangleMesh& mesh, const IndexLists& triangles_of_vertex,
                         const Eigen::VectorXd& vertex_areas, const Landmark& landmark, Loads loads) {
  if (landmark.vertex < 0 || landmark.vertex >= mesh.vertex_count()) {
    throw Error(ErrorCode::bad_input, "landmark " + landmark.name + ": vertex " + std::to_string(landmark.vertex) +
                                          " is not on the mesh, which has " + std::to_string(mesh.vertex_count()) +
                                          " vertices (counted from 0)");
  }
  if (!(landmark.radius >= 0) || !std::isfinite(landmark.radius)) {
    throw Error(ErrorCode::usage, "landmark " + landmark.name + ": the radius must be zero or positive");
  }
  const Spread phi{mesh.vertices.row(landmark.vertex), landmark.radius};
  constexpr double point = 0.01;  // of the shortest edge at the vertex
  if (loads == Loads::smooth && landmark.radius > point * shortest_edge(mesh, triangles_of_vertex, landmark.vertex)) {
    return smooth_patch(mesh, triangles_of_vertex, vertex_areas, landmark.vertex, phi);
  }
  return linear_patch(mesh, triangles_of_vertex, vertex_areas, landmark.vertex, phi);
}

}  // namespace skinbem
