// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/mesh/validate.hpp>

#include <Eigen/Geometry>
#include <algorithm>
#include <limits>
#include <tuple>

#include <skinbem/base/error.hpp>
#include <skinbem/mesh/nesting.hpp>
#include <skinbem/mesh/self_intersection.hpp>
#include <skinbem/mesh/surface_topology.hpp>
#include <skinbem/mesh/weld.hpp>

namespace skinbem {
namespace {

constexpr std::size_t most_places = 5;
constexpr std::size_t most_intersections = 1000;

class Inspector {
 public:
  explicit Inspector(const TriangleMesh& mesh) : mesh_(mesh) {}

  Inspection run() {
    if (!can_be_computed_with()) return std::move(result_);
    find_duplicate_vertices();
    find_odd_triangles();
    find_unreferenced_vertices();
    const SurfaceTopology surface = surface_topology(mesh_, sound_);
    report_surface(surface);
    const bool closed = result_.defects.empty();
    find_self_intersections();
    if (closed) find_bodies(surface);
    return std::move(result_);
  }

 private:
  /// Collects the places of one kind of defect.
  void add(DefectKind kind, Index first, Index second, const Vec3& position) {
    if (result_.defects.empty() || result_.defects.back().kind != kind) result_.defects.push_back({kind, 0, false, {}});
    Defect& defect = result_.defects.back();
    if (++defect.count <= static_cast<Index>(most_places)) defect.places.push_back({{first, second}, position});
  }
  void add_vertex(DefectKind kind, Index v, Index other = -1) { add(kind, v, other, vertex(v)); }
  void add_triangle(DefectKind kind, Index t, Index other = -1) { add(kind, t, other, centre(t)); }
  void add_edge(DefectKind kind, const std::array<std::int32_t, 2>& e) {
    add(kind, e[0], e[1], (vertex(e[0]) + vertex(e[1])) / 2);
  }
  Vec3 vertex(Index v) const { return mesh_.vertices.row(v); }
  Vec3 centre(Index t) const { return (mesh_.corner(t, 0) + mesh_.corner(t, 1) + mesh_.corner(t, 2)) / 3; }

  bool can_be_computed_with() {
    if (mesh_.vertex_count() == 0 || mesh_.triangle_count() == 0) {
      result_.defects.push_back({DefectKind::empty, 1, false, {}});
      return false;
    }
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      if (!mesh_.vertices.row(v).allFinite()) add_vertex(DefectKind::not_finite, v);
    }
    for (Index t = 0; t < mesh_.triangle_count(); ++t) {
      for (int c = 0; c < 3; ++c) {
        const Index v = mesh_.triangles(t, c);
        if (v >= 0 && v < mesh_.vertex_count()) continue;
        add(DefectKind::index_out_of_range, t, v, Vec3::Constant(std::numeric_limits<double>::quiet_NaN()));
        break;
      }
    }
    if (!result_.defects.empty()) {
      sort_by_importance();
      return false;
    }
    Index farthest = 0;
    const double reach = mesh_.vertices.cwiseAbs().rowwise().maxCoeff().maxCoeff(&farthest);
    constexpr double largest = 1e40, smallest = 1e-40;  // high powers of them and of much shorter edges are doubles
    if (reach <= largest && diagonal(mesh_) >= smallest) return true;
    add_vertex(DefectKind::size_out_of_range, farthest);
    return false;
  }

  void find_duplicate_vertices() {
    const std::vector<std::int32_t> first = first_equal_point(mesh_.vertices);
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      if (first[v] != v) add_vertex(DefectKind::duplicate_vertex, v, first[v]);
    }
  }

  /// Height over the longest edge lost in the rounding of the coordinates, or ten decimals below the edge.
  bool is_degenerate(Index t) const {
    const Vec3 a = mesh_.corner(t, 0), b = mesh_.corner(t, 1), c = mesh_.corner(t, 2);
    const double longest = std::max({(b - a).norm(), (c - b).norm(), (a - c).norm()});
    const double reach = std::max({a.cwiseAbs().maxCoeff(), b.cwiseAbs().maxCoeff(), c.cwiseAbs().maxCoeff()});
    const double lost = std::max(1e-10 * longest, 4 * std::numeric_limits<double>::epsilon() * reach);
    return !(area_vector(mesh_, t).norm() > lost * longest);
  }

  /// Leaves the triangles that are neither degenerate nor duplicates in sound_, those with three different vertices and
  /// no earlier duplicate in distinct_.
  void find_odd_triangles() {
    std::vector<char> degenerate(static_cast<std::size_t>(mesh_.triangle_count()), 0);
    for (Index t = 0; t < mesh_.triangle_count(); ++t) {
      degenerate[t] = is_degenerate(t);
      if (degenerate[t]) add_triangle(DefectKind::degenerate_triangle, t);
    }
    const std::vector<std::int32_t> original = first_with_the_same_vertices();
    for (Index t = 0; t < mesh_.triangle_count(); ++t) {
      const auto corners = mesh_.triangles.row(t);
      if (corners(0) == corners(1) || corners(1) == corners(2) || corners(2) == corners(0)) continue;
      if (original[t] != t) {
        add_triangle(DefectKind::duplicate_triangle, t, original[t]);
        continue;
      }
      sound_.push_back(static_cast<std::int32_t>(t));  // thin ones still close the surface
      if (!degenerate[t]) flat_.push_back(static_cast<std::int32_t>(t));
    }
  }

  std::vector<std::int32_t> first_with_the_same_vertices() const {
    struct Item {
      std::array<std::int32_t, 3> vertices;
      std::int32_t triangle;
    };
    std::vector<Item> items;
    items.reserve(static_cast<std::size_t>(mesh_.triangle_count()));
    for (Index t = 0; t < mesh_.triangle_count(); ++t) {
      Item item{{mesh_.triangles(t, 0), mesh_.triangles(t, 1), mesh_.triangles(t, 2)}, static_cast<std::int32_t>(t)};
      std::sort(item.vertices.begin(), item.vertices.end());
      items.push_back(item);
    }
    std::sort(items.begin(), items.end(), [](const Item& a, const Item& b) {
      return std::tie(a.vertices, a.triangle) < std::tie(b.vertices, b.triangle);
    });
    std::vector<std::int32_t> first(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) {
      const bool same = i > 0 && items[i].vertices == items[i - 1].vertices;
      first[items[i].triangle] = same ? first[items[i - 1].triangle] : items[i].triangle;
    }
    return first;
  }

  void find_unreferenced_vertices() {
    std::vector<char> used(static_cast<std::size_t>(mesh_.vertex_count()), 0);
    for (const std::int32_t v : mesh_.triangles.reshaped()) used[v] = 1;
    for (Index v = 0; v < mesh_.vertex_count(); ++v) {
      if (!used[v]) add_vertex(DefectKind::unreferenced_vertex, v);
    }
  }

  void report_surface(const SurfaceTopology& surface) {
    for (const OddEdge& e : surface.crowded_edges) add_edge(DefectKind::non_manifold_edge, e.vertices);
    for (const OddEdge& e : surface.open_edges) add_edge(DefectKind::open_edge, e.vertices);
    if (surface.one_sided.empty()) {
      for (const std::int32_t t : surface.flipped) add_triangle(DefectKind::inconsistent_orientation, t);
    }
    for (const auto& e : surface.one_sided) add_edge(DefectKind::one_sided, e);
    for (const std::int32_t v : surface.pinched_vertices) add_vertex(DefectKind::non_manifold_vertex, v);
  }

  void find_self_intersections() {
    const auto pairs = self_intersections(mesh_, flat_, most_intersections);
    for (const auto& [s, t] : pairs) add(DefectKind::self_intersection, s, t, (centre(s) + centre(t)) / 2);
    if (pairs.size() == most_intersections) result_.defects.back().at_least = true;
  }

  void find_bodies(const SurfaceTopology& surface) {
    const Nesting nesting = nesting_of_components(mesh_, surface.component, surface.component_count);
    for (const std::int32_t t : nesting.inside_out) add_triangle(DefectKind::inside_out, t);
    for (const std::int32_t t : nesting.further_bodies) add_triangle(DefectKind::several_bodies, t);
    if (!nesting.inside_out.empty() || !nesting.further_bodies.empty()) return;
    const Index euler = mesh_.vertex_count() - mesh_.triangle_count() / 2;
    result_.topology.components = surface.component_count;
    result_.topology.cavities = nesting.cavities;
    result_.topology.genus = surface.component_count - euler / 2;
  }

  void sort_by_importance() {
    std::sort(result_.defects.begin(), result_.defects.end(),
              [](const Defect& a, const Defect& b) { return a.kind < b.kind; });
  }

  const TriangleMesh& mesh_;
  Inspection result_;
  std::vector<std::int32_t> sound_;  // three different vertices, no copy of another
  std::vector<std::int32_t> flat_;   // those of them that have a plane
};

}  // namespace

Inspection inspect(const TriangleMesh& mesh) { return Inspector(mesh).run(); }

std::vector<Defect> find_defects(const TriangleMesh& mesh) { return inspect(mesh).defects; }

Body require_body(const TriangleMesh& mesh, const std::string& source, const BodyOptions& options) {
  Inspection found = inspect(mesh);
  Body body{found.topology, {}};
  std::vector<Defect> fatal;
  for (Defect& defect : found.defects) {
    const bool passes = options.force && defect.kind == DefectKind::self_intersection;
    (passes ? body.warnings : fatal).push_back(std::move(defect));
  }
  if (fatal.empty()) return body;
  std::string text = source + ": " + message(fatal.front());
  if (fatal.size() > 1) {
    text += " (and " + std::to_string(fatal.size() - 1) + (fatal.size() == 2 ? " other kind" : " other kinds") +
            " of defect)";
  }
  throw Error(ErrorCode::bad_input, text);
}

}  // namespace skinbem
