// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/mesh/self_intersection.hpp>

#include <Eigen/Geometry>
#include <algorithm>

#include <skinbem/mesh/predicates.hpp>
#include <skinbem/mesh/triangle_tree.hpp>
#include <skinbem/mesh/weld.hpp>

namespace skinbem {
namespace {

using Corners = std::array<Vec3, 3>;

/// Closed segments in one plane, seen in the coordinates u, v.
bool segments_meet(const Vec3& p, const Vec3& q, const Vec3& a, const Vec3& b, int u, int v) {
  const int pa = orientation_2d(p, q, a, u, v), pb = orientation_2d(p, q, b, u, v);
  const int ap = orientation_2d(a, b, p, u, v), aq = orientation_2d(a, b, q, u, v);
  if (pa == 0 && pb == 0) {  // on one line: compare extents
    for (const int d : {u, v}) {
      if (std::max(p(d), q(d)) < std::min(a(d), b(d)) || std::max(a(d), b(d)) < std::min(p(d), q(d))) return false;
    }
    return true;
  }
  return pa * pb <= 0 && ap * aq <= 0;
}

bool meet_in_plane(const Vec3& p, const Vec3& q, const Corners& t) {
  Index dropped = 0;
  (t[1] - t[0]).cross(t[2] - t[0]).cwiseAbs().maxCoeff(&dropped);
  const int u = static_cast<int>(dropped + 1) % 3, v = static_cast<int>(dropped + 2) % 3;
  const int a = orientation_2d(t[0], t[1], p, u, v), b = orientation_2d(t[1], t[2], p, u, v),
            c = orientation_2d(t[2], t[0], p, u, v);
  if ((a >= 0 && b >= 0 && c >= 0) || (a <= 0 && b <= 0 && c <= 0)) return true;
  return segments_meet(p, q, t[0], t[1], u, v) || segments_meet(p, q, t[1], t[2], u, v) ||
         segments_meet(p, q, t[2], t[0], u, v);
}

/// Closed segment and closed triangle; `side_p` and `side_q` are the sides of its ends on the triangle's plane.
bool segment_meets_triangle(const Vec3& p, const Vec3& q, int side_p, int side_q, const Corners& t) {
  if (side_p * side_q > 0) return false;
  if (side_p == 0 && side_q == 0) return meet_in_plane(p, q, t);
  const int a = orientation(p, q, t[0], t[1]), b = orientation(p, q, t[1], t[2]);
  if (a * b < 0) return false;
  const int c = orientation(p, q, t[2], t[0]);
  return a * c >= 0 && b * c >= 0;
}

std::array<int, 3> sides(const Corners& points, const Corners& plane) {
  std::array<int, 3> result;
  for (int i = 0; i < 3; ++i) result[i] = orientation(plane[0], plane[1], plane[2], points[i]);
  return result;
}

bool all_on_one_side(const std::array<int, 3>& s) { return s[0] * s[1] > 0 && s[0] * s[2] > 0; }

bool disjoint_triangles_meet(const Corners& a, const Corners& b) {
  const auto a_to_b = sides(a, b);
  if (all_on_one_side(a_to_b)) return false;
  const auto b_to_a = sides(b, a);
  if (all_on_one_side(b_to_a)) return false;
  for (int i = 0; i < 3; ++i) {
    const int j = (i + 1) % 3;
    if (segment_meets_triangle(a[i], a[j], a_to_b[i], a_to_b[j], b)) return true;
    if (segment_meets_triangle(b[i], b[j], b_to_a[i], b_to_a[j], a)) return true;
  }
  return false;
}

/// Corner 0 is common. What else they share reaches the edge opposite to it in one of them.
bool meet_beside_the_vertex(const Corners& a, const Corners& b) {
  const int a1 = orientation(b[0], b[1], b[2], a[1]), a2 = orientation(b[0], b[1], b[2], a[2]);
  if (a1 * a2 > 0) return false;
  const int b1 = orientation(a[0], a[1], a[2], b[1]), b2 = orientation(a[0], a[1], a[2], b[2]);
  if (b1 * b2 > 0) return false;
  return segment_meets_triangle(a[1], a[2], a1, a2, b) || segment_meets_triangle(b[1], b[2], b1, b2, a);
}

/// Corners 0 and 1 are common. An angle between the triangles below rounding is a fold.
bool folded_at_the_edge(const Corners& a, const Corners& b) {
  constexpr double flat = 1e-9;
  const Vec3 along = (a[1] - a[0]).normalized();
  const auto height = [&](const Vec3& p) -> Vec3 { return (p - a[0]) - along * along.dot(p - a[0]); };
  const Vec3 ha = height(a[2]), hb = height(b[2]);
  return ha.dot(hb) > 0 && ha.cross(hb).norm() <= flat * ha.norm() * hb.norm();
}

class PairTest {
 public:
  explicit PairTest(const TriangleMesh& mesh) : mesh_(mesh), same_(first_equal_point(mesh.vertices)) {}

  bool operator()(std::int32_t s, std::int32_t t) const {
    std::array<int, 3> order_s, order_t;
    const int common = common_first(s, t, order_s, order_t);
    if (common == 3) return false;
    const Corners a = corners(s, order_s), b = corners(t, order_t);
    if (common == 2) return folded_at_the_edge(a, b);
    return common == 1 ? meet_beside_the_vertex(a, b) : disjoint_triangles_meet(a, b);
  }

 private:
  /// Number of common corners; the orders list them first, in the same sequence.
  int common_first(std::int32_t s, std::int32_t t, std::array<int, 3>& order_s, std::array<int, 3>& order_t) const {
    order_s = order_t = {0, 1, 2};
    int common = 0;
    for (int i = 0; i < 3; ++i) {
      for (int j = common; j < 3; ++j) {
        if (same_[mesh_.triangles(s, i)] != same_[mesh_.triangles(t, order_t[j])]) continue;
        std::swap(order_t[common], order_t[j]);
        std::swap(order_s[common], *std::find(order_s.begin(), order_s.end(), i));
        ++common;
        break;
      }
    }
    return common;
  }
  Corners corners(std::int32_t t, const std::array<int, 3>& order) const {
    return {mesh_.corner(t, order[0]), mesh_.corner(t, order[1]), mesh_.corner(t, order[2])};
  }

  const TriangleMesh& mesh_;
  std::vector<std::int32_t> same_;
};

}  // namespace

std::vector<std::array<std::int32_t, 2>> self_intersections(const TriangleMesh& mesh,
                                                            std::vector<std::int32_t> triangles, std::size_t most) {
  std::vector<std::array<std::int32_t, 2>> found;
  const PairTest meet(mesh);
  const TriangleTree tree(mesh, std::move(triangles));
  tree.for_each_close_pair([&](std::int32_t s, std::int32_t t) {
    if (meet(s, t)) found.push_back({std::min(s, t), std::max(s, t)});
    return found.size() < most;
  });
  std::sort(found.begin(), found.end());
  return found;
}

}  // namespace skinbem
