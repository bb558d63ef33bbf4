// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/operator/free_term.hpp>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <tuple>

namespace skinbem {
namespace {

using std::numbers::pi;

/// An edge as a triangle sees it.
struct Side {
  std::int32_t from, to, triangle;
};

/// Both sides of each edge, one after the other.
std::vector<Side> paired_sides(const TriangleMesh& mesh) {
  std::vector<Side> sides;
  sides.reserve(static_cast<std::size_t>(mesh.triangles.size()));
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    for (int c = 0; c < 3; ++c) {
      sides.push_back({mesh.triangles(t, c), mesh.triangles(t, (c + 1) % 3), static_cast<std::int32_t>(t)});
    }
  }
  std::sort(sides.begin(), sides.end(), [](const Side& a, const Side& b) {
    const auto key = [](const Side& s) { return std::tuple(std::min(s.from, s.to), std::max(s.from, s.to), s.from); };
    return key(a) < key(b);
  });
  return sides;
}

/// By how much the surface turns across an edge: the angle from one normal to the other, positive where it is convex.
double turn(const TriangleMesh& mesh, const Side& side, const Side& other) {
  const Vec3 n = area_vector(mesh, side.triangle).normalized(), m = area_vector(mesh, other.triangle).normalized();
  const Vec3 edge = (mesh.vertices.row(side.to) - mesh.vertices.row(side.from)).normalized();
  return std::atan2(edge.dot(n.cross(m)), n.dot(m));
}

}  // namespace

std::vector<Mat3> free_terms(const TriangleMesh& mesh, double poisson) {
  std::vector<Mat3> terms(static_cast<std::size_t>(mesh.vertex_count()), 0.5 * Mat3::Identity());
  const std::vector<Side> sides = paired_sides(mesh);
  for (std::size_t k = 0; k + 1 < sides.size(); k += 2) {
    const double angle = turn(mesh, sides[k], sides[k + 1]);
    for (const std::int32_t end : {sides[k].from, sides[k].to}) terms[end] -= angle / (4 * pi) * Mat3::Identity();
  }
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    const Vec3 n = area_vector(mesh, t).normalized();
    for (int c = 0; c < 3; ++c) {
      const Vec3 first = (mesh.corner(t, (c + 1) % 3) - mesh.corner(t, c)).normalized();
      const Vec3 second = (mesh.corner(t, (c + 2) % 3) - mesh.corner(t, c)).normalized();
      terms[mesh.triangles(t, c)] += n * n.cross(second - first).transpose() / (8 * pi * (1 - poisson));
    }
  }
  return terms;
}

}  // namespace skinbem
