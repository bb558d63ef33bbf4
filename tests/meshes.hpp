// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Small named meshes for tests. The bodies are closed and face outward; the broken ones are named after their defect.
#pragma once

#include <array>
#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <map>
#include <numbers>
#include <utility>
#include <vector>

#include <skinbem/mesh/triangle_mesh.hpp>

namespace skinbem::testing_support {

// ---------------------------------------------------------------------------------------------- making and changing

/// Collects points and triangles.
class MeshMaker {
 public:
  std::int32_t vertex(const Vec3& p) {
    points_.push_back(p);
    return static_cast<std::int32_t>(points_.size()) - 1;
  }
  void triangle(std::int32_t a, std::int32_t b, std::int32_t c) { triangles_.push_back({a, b, c}); }
  /// Split along a-c.
  void quad(std::int32_t a, std::int32_t b, std::int32_t c, std::int32_t d) {
    triangle(a, b, c);
    triangle(a, c, d);
  }
  TriangleMesh mesh() const {
    TriangleMesh result;
    result.vertices.resize(static_cast<Index>(points_.size()), 3);
    result.triangles.resize(static_cast<Index>(triangles_.size()), 3);
    for (std::size_t i = 0; i < points_.size(); ++i) result.vertices.row(static_cast<Index>(i)) = points_[i];
    for (std::size_t t = 0; t < triangles_.size(); ++t) {
      for (int c = 0; c < 3; ++c) result.triangles(static_cast<Index>(t), c) = triangles_[t][c];
    }
    return result;
  }

 private:
  std::vector<Vec3> points_;
  std::vector<std::array<std::int32_t, 3>> triangles_;
};

inline TriangleMesh make_mesh(std::initializer_list<Vec3> points,
                              std::initializer_list<std::array<std::int32_t, 3>> triangles) {
  MeshMaker maker;
  for (const Vec3& p : points) maker.vertex(p);
  for (const auto& t : triangles) maker.triangle(t[0], t[1], t[2]);
  return maker.mesh();
}

/// Facing the other way.
inline TriangleMesh reversed(TriangleMesh mesh) {
  mesh.triangles.col(1).swap(mesh.triangles.col(2));
  return mesh;
}

inline TriangleMesh moved(TriangleMesh mesh, const Vec3& offset) {
  mesh.vertices.rowwise() += offset.transpose();
  return mesh;
}

inline TriangleMesh stretched(TriangleMesh mesh, const Vec3& factors) {
  mesh.vertices.array().rowwise() *= factors.transpose().array();
  return mesh;
}

/// Both surfaces in one mesh, `b`'s vertices after `a`'s.
inline TriangleMesh joined(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh result;
  result.vertices.resize(a.vertex_count() + b.vertex_count(), 3);
  result.vertices << a.vertices, b.vertices;
  result.triangles.resize(a.triangle_count() + b.triangle_count(), 3);
  result.triangles << a.triangles, (b.triangles.array() + static_cast<std::int32_t>(a.vertex_count())).matrix();
  return result;
}

/// Every triangle with three vertices of its own.
inline TriangleMesh soup(const TriangleMesh& mesh) {
  MeshMaker maker;
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    const auto a = maker.vertex(mesh.corner(t, 0));
    const auto b = maker.vertex(mesh.corner(t, 1));
    const auto c = maker.vertex(mesh.corner(t, 2));
    maker.triangle(a, b, c);
  }
  return maker.mesh();
}

// ----------------------------------------------------------------------------------------------------------- bodies

/// The corner of the unit cube: volume 1/6.
inline TriangleMesh tetrahedron() {
  return make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
}

/// Surface of the cells (i, j, k), 0 <= i < counts[0] and so on, for which `filled` holds; two triangles a cell face.
/// Cells that touch only along an edge or at a corner share its vertices: that makes non-manifold meshes.
template <class Filled>
TriangleMesh cell_surface(const std::array<int, 3>& counts, const Vec3& cell, Filled filled) {
  MeshMaker maker;
  std::map<std::array<int, 3>, std::int32_t> nodes;
  const auto node = [&](const std::array<int, 3>& p) {
    const auto [place, fresh] = nodes.try_emplace(p, 0);
    if (fresh) place->second = maker.vertex(cell.cwiseProduct(Vec3(p[0], p[1], p[2])));
    return place->second;
  };
  const auto inside = [&](const std::array<int, 3>& c) {
    for (int d = 0; d < 3; ++d) {
      if (c[d] < 0 || c[d] >= counts[d]) return false;
    }
    return static_cast<bool>(filled(c[0], c[1], c[2]));
  };
  const auto face = [&](const std::array<int, 3>& c, int d, bool upper) {
    const int u = (d + 1) % 3, v = (d + 2) % 3;
    std::array<int, 3> p = c;
    p[d] += upper ? 1 : 0;
    std::array<int, 3> q = p, r = p, s = p;
    ++q[u], ++r[u], ++r[v], ++s[v];
    if (upper) {
      maker.quad(node(p), node(q), node(r), node(s));
    } else {
      maker.quad(node(p), node(s), node(r), node(q));
    }
  };
  for (int i = 0; i < counts[0]; ++i) {
    for (int j = 0; j < counts[1]; ++j) {
      for (int k = 0; k < counts[2]; ++k) {
        if (!inside({i, j, k})) continue;
        for (int d = 0; d < 3; ++d) {
          for (const int side : {-1, 1}) {
            std::array<int, 3> neighbour{i, j, k};
            neighbour[d] += side;
            if (!inside(neighbour)) face({i, j, k}, d, side > 0);
          }
        }
      }
    }
  }
  return maker.mesh();
}

/// [0, size] with counts[0] x counts[1] x counts[2] cells.
inline TriangleMesh box(const Vec3& size, const std::array<int, 3>& counts) {
  return cell_surface(counts, size.cwiseQuotient(Vec3(counts[0], counts[1], counts[2])),
                      [](int, int, int) { return true; });
}
/// The unit cube, n x n squares a face.
inline TriangleMesh cube(int n = 1) { return box({1, 1, 1}, {n, n, n}); }
/// 1 x 1 x thickness.
inline TriangleMesh thin_slab(int n, double thickness = 0.05, int layers = 1) {
  return box({1, 1, thickness}, {n, n, layers});
}
/// 10 x 0.5 x 0.5.
inline TriangleMesh needle_box(int n = 20) { return box({10, 0.5, 0.5}, {n, 1, 1}); }
/// A re-entrant edge: three quarters of 1 x 1, height 1/2; n cells along the half side.
inline TriangleMesh l_shape(int n = 1) {
  return cell_surface({2 * n, 2 * n, n}, Vec3::Constant(0.5 / n), [n](int i, int j, int) { return i < n || j < n; });
}
/// Genus 1 with sharp edges: a square ring of 3 x 3 x 1.
inline TriangleMesh square_ring() {
  return cell_surface({3, 3, 1}, {1, 1, 1}, [](int i, int j, int) { return i != 1 || j != 1; });
}

/// Subdivided icosahedron projected on the sphere: 10 * 4^level + 2 vertices, 20 * 4^level triangles.
inline TriangleMesh icosphere(int level, double radius = 1) {
  const double g = std::numbers::phi;
  std::vector<Vec3> points{{-1, g, 0},  {1, g, 0},  {-1, -g, 0}, {1, -g, 0}, {0, -1, g},  {0, 1, g},
                           {0, -1, -g}, {0, 1, -g}, {g, 0, -1},  {g, 0, 1},  {-g, 0, -1}, {-g, 0, 1}};
  std::vector<std::array<std::int32_t, 3>> triangles{{0, 11, 5}, {0, 5, 1},  {0, 1, 7},   {0, 7, 10}, {0, 10, 11},
                                                     {1, 5, 9},  {5, 11, 4}, {11, 10, 2}, {10, 7, 6}, {7, 1, 8},
                                                     {3, 9, 4},  {3, 4, 2},  {3, 2, 6},   {3, 6, 8},  {3, 8, 9},
                                                     {4, 9, 5},  {2, 4, 11}, {6, 2, 10},  {8, 6, 7},  {9, 8, 1}};
  for (int l = 0; l < level; ++l) {
    std::map<std::pair<std::int32_t, std::int32_t>, std::int32_t> middles;
    const auto middle = [&](std::int32_t a, std::int32_t b) {
      const auto [place, fresh] = middles.try_emplace(std::minmax(a, b), static_cast<std::int32_t>(points.size()));
      if (fresh) points.push_back(((points[a] + points[b]) / 2).normalized());
      return place->second;
    };
    if (l == 0) {
      for (Vec3& p : points) p.normalize();
    }
    std::vector<std::array<std::int32_t, 3>> finer;
    for (const auto& [a, b, c] : triangles) {
      const auto ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
      finer.insert(finer.end(), {{a, ab, ca}, {b, bc, ab}, {c, ca, bc}, {ab, bc, ca}});
    }
    triangles = std::move(finer);
  }
  MeshMaker maker;
  for (const Vec3& p : points) maker.vertex(radius * p.normalized());
  for (const auto& t : triangles) maker.triangle(t[0], t[1], t[2]);
  return maker.mesh();
}

/// Half axes `axes`.
inline TriangleMesh ellipsoid(int level, const Vec3& axes) { return stretched(icosphere(level), axes); }
inline TriangleMesh slender_ellipsoid(int level) { return ellipsoid(level, {6, 1, 1}); }

/// A sphere with one vertex pulled out to `length`: slivers that meet in a needle's tip.
inline TriangleMesh spiked_sphere(int level, double length = 4) {
  TriangleMesh mesh = icosphere(level);
  mesh.vertices.row(0) *= length;
  return mesh;
}

/// Genus 1 about z; n steps around the axis, m around the tube.
inline TriangleMesh torus(double ring_radius = 1, double tube_radius = 0.4, int n = 16, int m = 8) {
  MeshMaker maker;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      const double a = 2 * std::numbers::pi * i / n, b = 2 * std::numbers::pi * j / m;
      const double r = ring_radius + tube_radius * std::cos(b);
      maker.vertex({r * std::cos(a), r * std::sin(a), tube_radius * std::sin(b)});
    }
  }
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      const int i1 = (i + 1) % n, j1 = (j + 1) % m;
      maker.quad(i * m + j, i1 * m + j, i1 * m + j1, i * m + j1);
    }
  }
  return maker.mesh();
}

/// A sphere with a concentric cavity, whose surface faces inward.
inline TriangleMesh hollow_sphere(int level, double outer = 1, double inner = 0.5) {
  return joined(icosphere(level, outer), reversed(icosphere(level, inner)));
}

// ----------------------------------------------------------------------------------------------------------- broken

/// The mantle of an n-sided cone, without its base: n open edges.
inline TriangleMesh open_cone(int n = 5) {
  MeshMaker maker;
  const auto apex = maker.vertex({0, 0, 1});
  for (int i = 0; i < n; ++i) {
    const double a = 2 * std::numbers::pi * i / n;
    maker.vertex({std::cos(a), std::sin(a), 0});
  }
  for (int i = 0; i < n; ++i) maker.triangle(apex, 1 + i, 1 + (i + 1) % n);
  return maker.mesh();
}

/// Two cubes that share one vertex.
inline TriangleMesh non_manifold_vertex() {
  return cell_surface({2, 2, 2}, {1, 1, 1}, [](int i, int j, int k) { return i == j && j == k; });
}

/// Two cubes that share one edge, which lies in four triangles.
inline TriangleMesh non_manifold_edge() {
  return cell_surface({2, 2, 1}, {1, 1, 1}, [](int i, int j, int) { return i == j; });
}

inline TriangleMesh flipped_triangle() {
  TriangleMesh mesh = icosphere(1);
  std::swap(mesh.triangles(7, 1), mesh.triangles(7, 2));
  return mesh;
}

/// Closed and two-sided nowhere: its orientations cannot be made consistent. Also intersects itself.
inline TriangleMesh klein_bottle(int n = 16, int m = 8) {
  MeshMaker maker;
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) {
      const double a = 2 * std::numbers::pi * i / n, b = 2 * std::numbers::pi * (j + 0.5) / m;
      const double s = std::sin(b), s2 = std::sin(2 * b);
      const double r = 2 + std::cos(a / 2) * s - std::sin(a / 2) * s2;
      maker.vertex({r * std::cos(a), r * std::sin(a), std::sin(a / 2) * s + std::cos(a / 2) * s2});
    }
  }
  const auto node = [&](int i, int j) {  // once around, the figure of eight has turned by half a turn
    if (i == n) return (2 * m - 1 - j) % m;
    return i * m + j % m;
  };
  for (int i = 0; i < n; ++i) {
    for (int j = 0; j < m; ++j) maker.quad(node(i, j), node(i + 1, j), node(i + 1, j + 1), node(i, j + 1));
  }
  return maker.mesh();
}

/// A sphere one vertex of which was pulled through the opposite side.
inline TriangleMesh self_intersecting_sphere(int level = 2) {
  TriangleMesh mesh = icosphere(level);
  mesh.vertices.row(0) *= -1.5;
  return mesh;
}

}  // namespace skinbem::testing_support
