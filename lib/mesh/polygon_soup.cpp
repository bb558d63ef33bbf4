// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/mesh/polygon_soup.hpp>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <span>

#include <skinbem/base/error.hpp>
#include <skinbem/mesh/text_scanner.hpp>

namespace skinbem {
namespace {

constexpr std::size_t most_corners = 1000;

using Point2 = Eigen::Vector2d;

double cross(const Point2& a, const Point2& b) { return a.x() * b.y() - a.y() * b.x(); }
double twice_area(const Point2& a, const Point2& b, const Point2& c) { return cross(b - a, c - a); }

/// Twice the area over the square of the longest side: 0 for a sliver, 0.87 for an equilateral triangle.
double shape(const Point2& a, const Point2& b, const Point2& c) {
  const double longest = std::max({(b - a).squaredNorm(), (c - b).squaredNorm(), (a - c).squaredNorm()});
  return longest > 0 ? twice_area(a, b, c) / longest : 0;
}

bool contains(const Point2& a, const Point2& b, const Point2& c, const Point2& p) {
  return p != a && p != b && p != c && twice_area(a, b, p) >= 0 && twice_area(b, c, p) >= 0 && twice_area(c, a, p) >= 0;
}

/// The points in the plane across their Newell normal, counter-clockwise.
std::vector<Point2> in_their_plane(const std::vector<Vec3>& points) {
  Vec3 normal = Vec3::Zero();
  for (std::size_t i = 0; i < points.size(); ++i) {
    normal += (points[i] - points[0]).cross(points[(i + 1) % points.size()] - points[0]);
  }
  const Vec3 axis = normal.unitOrthogonal();
  const Vec3 other = normal.cross(axis).normalized();
  std::vector<Point2> result;
  for (const Vec3& p : points) result.emplace_back(axis.dot(p - points[0]), other.dot(p - points[0]));
  return result;
}

/// Position in `ring` of the ear of best shape; 1 when a crossing or collapsed outline has none: the triangles then
/// show the defect to the validation.
std::size_t best_ear(const std::vector<Point2>& points, const std::vector<std::size_t>& ring) {
  constexpr double clearly_better = 1 + 1e-9;  // equal shapes are not to be told apart by rounding
  const std::size_t n = ring.size();
  std::size_t best = 1;
  double best_shape = 0;
  for (std::size_t step = 0; step < n; ++step) {
    const std::size_t i = (step + 1) % n;
    const Point2 &a = points[ring[(i + n - 1) % n]], &b = points[ring[i]], &c = points[ring[(i + 1) % n]];
    const double s = shape(a, b, c);
    if (!(s > best_shape * clearly_better)) continue;
    if (std::any_of(ring.begin(), ring.end(), [&](std::size_t p) { return contains(a, b, c, points[p]); })) continue;
    best = i;
    best_shape = s;
  }
  return best;
}

class Triangulator {
 public:
  explicit Triangulator(const PolygonSoup& soup) : soup_(soup) {}

  TriangleMesh run() {
    if (soup_.coordinates.empty()) fail_file("no vertices in it, check the file and its extension");
    if (soup_.ends.empty()) fail_file("no faces in it, a surface is needed (not a point cloud)");
    if (soup_.vertex_count() > std::numeric_limits<std::int32_t>::max()) fail_file("more than 2^31 - 1 vertices");
    triangles_.reserve(3 * soup_.ends.size());
    std::size_t begin = 0;
    for (std::size_t f = 0; f < soup_.ends.size(); ++f) {
      const std::span<const std::int64_t> face(soup_.corners.data() + begin, soup_.ends[f] - begin);
      check(face, f);
      split(face);
      begin = soup_.ends[f];
    }
    TriangleMesh mesh;
    mesh.vertices = Eigen::Map<const Points>(soup_.coordinates.data(), soup_.vertex_count(), 3);
    mesh.triangles = Eigen::Map<const Triangles>(triangles_.data(), static_cast<Index>(triangles_.size() / 3), 3);
    return mesh;
  }

 private:
  [[noreturn]] void fail_file(const std::string& message) const {
    throw Error(ErrorCode::bad_input, soup_.name + ": " + message);
  }
  [[noreturn]] void fail(std::size_t face, const std::string& message) const {
    if (soup_.places_are_bytes) {
      fail_at_byte(soup_.name, static_cast<std::size_t>(soup_.places[face]),
                   "face " + std::to_string(face) + ": " + message);
    }
    fail_at_line(soup_.name, soup_.places[face], message);
  }
  std::string in_file_numbering(std::int64_t vertex) const { return std::to_string(vertex + soup_.first_index); }

  void check(std::span<const std::int64_t> face, std::size_t f) const {
    if (face.size() < 3) fail(f, "a face of " + std::to_string(face.size()) + " corners, at least 3 are needed");
    if (face.size() > most_corners) {
      fail(f, "a face of " + std::to_string(face.size()) + " corners, split it into triangles");
    }
    for (const std::int64_t v : face) {
      if (v < 0 || v >= soup_.vertex_count()) {
        fail(f, "face refers to vertex " + in_file_numbering(v) + ", but the vertices are " + in_file_numbering(0) +
                    " to " + in_file_numbering(soup_.vertex_count() - 1) + ", correct the index");
      }
    }
    for (std::size_t i = 0; i < face.size(); ++i) {
      for (std::size_t j = i + 1; j < face.size(); ++j) {
        if (face[i] == face[j])
          fail(f, "degenerate face: vertex " + in_file_numbering(face[i]) + " twice in it, remove the face");
      }
    }
  }

  void add(std::int64_t a, std::int64_t b, std::int64_t c) {
    for (const std::int64_t v : {a, b, c}) triangles_.push_back(static_cast<std::int32_t>(v));
  }

  void split(std::span<const std::int64_t> face) {
    if (face.size() == 3) return add(face[0], face[1], face[2]);
    std::vector<Vec3> corners;
    for (const std::int64_t v : face) corners.push_back(Eigen::Map<const Vec3>(&soup_.coordinates[3 * v]));
    const std::vector<Point2> points = in_their_plane(corners);
    std::vector<std::size_t> ring(face.size());
    for (std::size_t i = 0; i < ring.size(); ++i) ring[i] = i;
    while (ring.size() > 3) {
      const std::size_t ear = best_ear(points, ring), n = ring.size();
      add(face[ring[(ear + n - 1) % n]], face[ring[ear]], face[ring[(ear + 1) % n]]);
      ring.erase(ring.begin() + static_cast<std::ptrdiff_t>(ear));
    }
    add(face[ring[0]], face[ring[1]], face[ring[2]]);
  }

  const PolygonSoup& soup_;
  std::vector<std::int32_t> triangles_;
};

}  // namespace

TriangleMesh triangulated(const PolygonSoup& soup) { return Triangulator(soup).run(); }

}  // namespace skinbem
