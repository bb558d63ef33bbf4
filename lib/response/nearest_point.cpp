// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/response/nearest_point.hpp>

#include <algorithm>
#include <array>
#include <limits>

namespace skinbem {
namespace {

/// Share of `b` at the point of segment a-b nearest to p.
double share_on_segment(const Vec3& p, const Vec3& a, const Vec3& b) {
  const double length2 = (b - a).squaredNorm();
  return length2 > 0 ? std::clamp((p - a).dot(b - a) / length2, 0.0, 1.0) : 0;
}

/// Barycentric coordinates of the point of triangle a, b, c nearest to p: the foot of the perpendicular where it is
/// inside, else the best of the three edges.
Vec3 nearest_in_triangle(const Vec3& p, const std::array<Vec3, 3>& corner) {
  const Vec3 ab = corner[1] - corner[0];
  const Vec3 ac = corner[2] - corner[0];
  const Vec3 ap = p - corner[0];
  const double bb = ab.squaredNorm(), cc = ac.squaredNorm(), bc = ab.dot(ac);
  const double determinant = bb * cc - bc * bc;
  const double v = (cc * ab.dot(ap) - bc * ac.dot(ap)) / determinant;
  const double w = (bb * ac.dot(ap) - bc * ab.dot(ap)) / determinant;
  if (v >= 0 && w >= 0 && v + w <= 1) return {1 - v - w, v, w};  // false where a degenerate triangle gives NaN
  Vec3 best = Vec3::UnitX();
  double nearest = std::numeric_limits<double>::infinity();
  for (std::size_t e = 0; e < 3; ++e) {
    const std::size_t f = (e + 1) % 3;
    const double share = share_on_segment(p, corner[e], corner[f]);
    const double distance = ((1 - share) * corner[e] + share * corner[f] - p).squaredNorm();
    if (distance < nearest) {
      nearest = distance;
      best.setZero();
      best(Index(e)) = 1 - share;
      best(Index(f)) = share;
    }
  }
  return best;
}

}  // namespace

SurfacePoint nearest_point(const TriangleMesh& mesh, const Vec3& point) {
  SurfacePoint best;
  double nearest = std::numeric_limits<double>::infinity();
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    const std::array<Vec3, 3> corner = {mesh.corner(t, 0), mesh.corner(t, 1), mesh.corner(t, 2)};
    // Distance to the triangle's box first: few triangles are looked at closer.
    const Vec3 low = corner[0].cwiseMin(corner[1]).cwiseMin(corner[2]);
    const Vec3 high = corner[0].cwiseMax(corner[1]).cwiseMax(corner[2]);
    if ((low - point).cwiseMax(point - high).cwiseMax(0).squaredNorm() >= nearest) continue;
    const Vec3 barycentric = nearest_in_triangle(point, corner);
    const Vec3 position = barycentric(0) * corner[0] + barycentric(1) * corner[1] + barycentric(2) * corner[2];
    const double distance = (position - point).squaredNorm();
    if (distance < nearest) {
      nearest = distance;
      best = {t, barycentric, position};
    }
  }
  return best;
}

}  // namespace skinbem
