// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/mesh/closest_point.hpp>

#include <Eigen/Geometry>
#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>
#include <utility>

#include <skinbem/base/error.hpp>

namespace skinbem {
namespace {

/// Parameter in [0, 1] of the point of segment a-b closest to p.
double closest_parameter(const Vec3& a, const Vec3& b, const Vec3& p) {
  const double length2 = (b - a).squaredNorm();
  return length2 > 0 ? std::clamp((p - a).dot(b - a) / length2, 0.0, 1.0) : 0.0;
}

/// Over 4 pi: how often the triangle winds around p.
double solid_angle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const Vec3 x = a - p, y = b - p, z = c - p;
  const double nx = x.norm(), ny = y.norm(), nz = z.norm();
  const double upper = x.dot(y.cross(z));
  const double lower = nx * ny * nz + x.dot(y) * nz + y.dot(z) * nx + z.dot(x) * ny;
  return std::atan2(upper, lower) / (2 * std::numbers::pi);
}

}  // namespace

SurfacePoint closest_point_of_triangle(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& p) {
  const Vec3 normal = (b - a).cross(c - a);
  const double area2 = normal.squaredNorm();
  SurfacePoint result;
  if (area2 > 0) {
    const double wb = (p - a).cross(c - a).dot(normal) / area2, wc = (b - a).cross(p - a).dot(normal) / area2;
    result.barycentric = {1 - wb - wc, wb, wc};
  }
  if (area2 == 0 || result.barycentric.minCoeff() < 0) {  // then it is on an edge: the nearest of the three
    const std::array<Vec3, 3> corners{a, b, c};
    double nearest = std::numeric_limits<double>::infinity();
    for (int i = 0; i < 3; ++i) {
      const int j = (i + 1) % 3;
      const double s = closest_parameter(corners[i], corners[j], p);
      const double distance2 = (corners[i] + s * (corners[j] - corners[i]) - p).squaredNorm();
      if (!(distance2 < nearest)) continue;
      nearest = distance2;
      result.barycentric.setZero();
      result.barycentric(i) = 1 - s;
      result.barycentric(j) = s;
    }
  }
  const Vec3& w = result.barycentric;
  result.position = w(0) * a + w(1) * b + w(2) * c;
  result.distance = (result.position - p).norm();
  return result;
}

SurfaceQuery::SurfaceQuery(TriangleMesh mesh) : mesh_(std::move(mesh)), tree_(mesh_) {
  if (mesh_.triangle_count() == 0)
    throw Error(ErrorCode::bad_input, "a surface without triangles has no closest point");
  dipoles_.reserve(tree_.nodes().size());
  for (const TriangleTree::Node& node : tree_.nodes()) {
    Dipole dipole{Vec3::Zero(), Vec3::Zero(), 0};
    double weight = 0;
    for (const std::int32_t t : tree_.triangles_of(node)) {
      const Vec3 area = area_vector(mesh_, t) / 2;
      dipole.area += area;
      dipole.centre += area.norm() * (mesh_.corner(t, 0) + mesh_.corner(t, 1) + mesh_.corner(t, 2)) / 3;
      weight += area.norm();
    }
    if (weight > 0) {
      dipole.centre /= weight;
    } else {
      dipole.centre = node.box.center();
    }
    const Vec3 reach = (dipole.centre - node.box.min()).cwiseMax(node.box.max() - dipole.centre);
    dipole.radius = reach.norm();
    dipoles_.push_back(dipole);
  }
}

SurfacePoint SurfaceQuery::closest(const Vec3& p) const {
  const auto& nodes = tree_.nodes();
  SurfacePoint best;
  best.distance = std::numeric_limits<double>::infinity();
  std::vector<std::pair<double, std::int32_t>> pending{{nodes[0].box.squaredExteriorDistance(p), 0}};
  while (!pending.empty()) {
    const auto [distance2, n] = pending.back();
    pending.pop_back();
    if (distance2 > best.distance * best.distance) continue;
    if (nodes[n].is_leaf()) {
      for (const std::int32_t t : tree_.triangles_of(nodes[n])) {
        SurfacePoint point = closest_point_of_triangle(mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2), p);
        if (!(point.distance < best.distance)) continue;
        best = point;
        best.triangle = t;
      }
      continue;
    }
    std::pair<double, std::int32_t> near{nodes[n + 1].box.squaredExteriorDistance(p), n + 1};
    std::pair<double, std::int32_t> far{nodes[nodes[n].right].box.squaredExteriorDistance(p), nodes[n].right};
    if (far.first < near.first) std::swap(near, far);
    pending.push_back(far);
    pending.push_back(near);
  }
  return best;
}

double SurfaceQuery::winding_number(const Vec3& p) const {
  constexpr double far = 3;  // radii: the dipole's error falls with the square
  const auto& nodes = tree_.nodes();
  double sum = 0;
  std::vector<std::int32_t> pending{0};
  while (!pending.empty()) {
    const std::int32_t n = pending.back();
    pending.pop_back();
    const Dipole& dipole = dipoles_[n];
    const Vec3 away = dipole.centre - p;
    const double distance = away.norm();
    if (distance > far * dipole.radius) {
      sum += dipole.area.dot(away) / (4 * std::numbers::pi * distance * distance * distance);
    } else if (nodes[n].is_leaf()) {
      for (const std::int32_t t : tree_.triangles_of(nodes[n])) {
        sum += solid_angle(mesh_.corner(t, 0), mesh_.corner(t, 1), mesh_.corner(t, 2), p);
      }
    } else {
      pending.push_back(nodes[n].right);
      pending.push_back(n + 1);
    }
  }
  return sum;
}

}  // namespace skinbem
