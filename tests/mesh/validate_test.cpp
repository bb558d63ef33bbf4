// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/mesh/validate.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>

#include <Eigen/Geometry>
#include <skinbem/base/error.hpp>
#include <skinbem/mesh/mesh_io.hpp>
#include <skinbem/mesh/weld.hpp>

#include "files.hpp"
#include "meshes.hpp"

namespace skinbem {
namespace {

using namespace testing_support;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::Not;

std::vector<DefectKind> kinds(const TriangleMesh& mesh) {
  std::vector<DefectKind> result;
  for (const Defect& defect : find_defects(mesh)) {
    result.push_back(defect.kind);
    EXPECT_GT(defect.count, 0);
    EXPECT_THAT(message(defect), Not(HasSubstr("\n")));
  }
  EXPECT_TRUE(std::is_sorted(result.begin(), result.end()));
  return result;
}

/// The only defect of a mesh.
Defect defect_of(const TriangleMesh& mesh) {
  const std::vector<Defect> defects = find_defects(mesh);
  EXPECT_EQ(defects.size(), 1u) << (defects.empty() ? "none" : message(defects.back()));
  return defects.empty() ? Defect{DefectKind::empty, 0, false, {}} : defects.front();
}

TriangleMesh without_triangle(TriangleMesh mesh, Index t) {
  const Index last = mesh.triangle_count() - 1;
  mesh.triangles.row(t) = mesh.triangles.row(last).eval();
  mesh.triangles.conservativeResize(last, 3);
  return mesh;
}

TriangleMesh with_triangle(TriangleMesh mesh, std::int32_t a, std::int32_t b, std::int32_t c) {
  mesh.triangles.conservativeResize(mesh.triangle_count() + 1, 3);
  mesh.triangles.bottomRows(1) << a, b, c;
  return mesh;
}

TEST(Validate, AcceptsBodiesOfEveryShapeAndCountsTheirHandlesAndCavities) {
  struct Case {
    TriangleMesh mesh;
    Index genus, cavities;
  };
  for (const auto& [mesh, genus, cavities] :
       {Case{tetrahedron(), 0, 0}, Case{cube(3), 0, 0}, Case{icosphere(3), 0, 0}, Case{l_shape(2), 0, 0},
        Case{needle_box(), 0, 0}, Case{thin_slab(8, 1e-3), 0, 0}, Case{slender_ellipsoid(2), 0, 0}, Case{torus(), 1, 0},
        Case{square_ring(), 1, 0}, Case{hollow_sphere(2), 0, 1},
        Case{joined(hollow_sphere(2, 1, 0.2), moved(reversed(torus(0.1, 0.04)), {0.5, 0, 0})), 1, 2}}) {
    const Body body = require_body(mesh, "m");
    EXPECT_EQ(body.topology.genus, genus);
    EXPECT_EQ(body.topology.cavities, cavities);
    EXPECT_EQ(body.topology.components, cavities + 1);
    EXPECT_THAT(body.warnings, IsEmpty());
  }
}

TEST(Validate, DoesNotDependOnPlaceScaleOrRotation) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> angle(-3, 3);
  for (int i = 0; i < 20; ++i) {
    const Mat3 turn =
        (Eigen::AngleAxisd(angle(random), Vec3::UnitX()) * Eigen::AngleAxisd(angle(random), Vec3::UnitY()) *
         Eigen::AngleAxisd(angle(random), Vec3::UnitZ()))
            .toRotationMatrix();
    for (TriangleMesh mesh : {cube(4), l_shape(3), square_ring(), thin_slab(6, 1e-4), hollow_sphere(1)}) {
      mesh.vertices = (std::pow(10, 10 * angle(random)) * (mesh.vertices * turn)).eval();
      EXPECT_THAT(kinds(mesh), IsEmpty());
      mesh = moved(mesh, diagonal(mesh) * Vec3(100, -300, 50));
      EXPECT_THAT(kinds(mesh), IsEmpty());
      EXPECT_THAT(kinds(reversed(mesh)), ElementsAre(DefectKind::inside_out));
    }
  }
}

TEST(Validate, NamesEachDefectAlone) {
  EXPECT_EQ(defect_of({}).kind, DefectKind::empty);
  TriangleMesh no_triangles = tetrahedron();
  no_triangles.triangles.resize(0, 3);
  EXPECT_EQ(defect_of(no_triangles).kind, DefectKind::empty);
  EXPECT_EQ(defect_of(with_triangle(tetrahedron(), 0, 1, 4)).kind, DefectKind::index_out_of_range);
  EXPECT_EQ(defect_of(with_triangle(tetrahedron(), 0, 1, -1)).kind, DefectKind::index_out_of_range);
  EXPECT_EQ(defect_of(with_triangle(tetrahedron(), 0, 1, 1)).kind, DefectKind::degenerate_triangle);
  EXPECT_EQ(defect_of(with_triangle(tetrahedron(), 3, 0, 1)).kind, DefectKind::duplicate_triangle);
  EXPECT_EQ(defect_of(with_triangle(tetrahedron(), 1, 0, 3)).kind, DefectKind::duplicate_triangle);
  EXPECT_EQ(defect_of(non_manifold_edge()).kind, DefectKind::non_manifold_edge);
  EXPECT_EQ(defect_of(open_cone()).kind, DefectKind::open_edge);
  EXPECT_EQ(defect_of(open_cone(7)).count, 7);
  EXPECT_EQ(defect_of(without_triangle(icosphere(1), 5)).count, 3);
  EXPECT_EQ(defect_of(non_manifold_vertex()).kind, DefectKind::non_manifold_vertex);
  EXPECT_EQ(defect_of(self_intersecting_sphere()).kind, DefectKind::self_intersection);
  EXPECT_EQ(defect_of(reversed(torus())).kind, DefectKind::inside_out);
  EXPECT_EQ(defect_of(reversed(hollow_sphere(1))).kind, DefectKind::inside_out);
  EXPECT_EQ(defect_of(joined(cube(), moved(cube(), {2, 0, 0}))).kind, DefectKind::several_bodies);
  EXPECT_THAT(kinds(joined(cube(), moved(reversed(cube()), {2, 0, 0}))),
              ElementsAre(DefectKind::inside_out, DefectKind::several_bodies));
}

TEST(Validate, NamesPlaces) {
  TriangleMesh mesh = icosphere(1);
  mesh.vertices(5, 1) = std::nan("");
  mesh.vertices(9, 2) = std::numeric_limits<double>::infinity();
  Defect defect = defect_of(mesh);
  EXPECT_EQ(defect.kind, DefectKind::not_finite);
  EXPECT_EQ(defect.count, 2);
  EXPECT_EQ(defect.places.front().elements[0], 5);

  defect = defect_of(flipped_triangle());
  EXPECT_EQ(defect.kind, DefectKind::inconsistent_orientation);
  EXPECT_EQ(defect.count, 1);
  EXPECT_EQ(defect.places.front().elements[0], 7);

  mesh = tetrahedron();
  mesh.vertices.conservativeResize(5, 3);
  mesh.vertices.row(4) << 3, 4, 5;
  defect = defect_of(mesh);
  EXPECT_EQ(defect.kind, DefectKind::unreferenced_vertex);
  EXPECT_EQ(message(defect), "1 unreferenced vertex: vertex 4 at (3, 4, 5), remove it: no triangle uses it");
}

TEST(Validate, TellsCavitiesFromBodiesWithinBodies) {
  const TriangleMesh nested_outward = joined(icosphere(2), icosphere(2, 0.5));
  EXPECT_EQ(defect_of(nested_outward).kind, DefectKind::several_bodies);
  EXPECT_EQ(defect_of(nested_outward).places.front().elements[0], icosphere(2).triangle_count());
  const TriangleMesh island = joined(hollow_sphere(2), icosphere(2, 0.2));
  EXPECT_EQ(defect_of(island).kind, DefectKind::several_bodies);
  const TriangleMesh cavity_first = joined(reversed(icosphere(2, 0.5)), icosphere(2));
  EXPECT_EQ(require_body(cavity_first, "m").topology.cavities, 1);
  // In the box of the ring, but not inside it.
  EXPECT_EQ(defect_of(joined(torus(), icosphere(1, 0.1))).kind, DefectKind::several_bodies);
}

TEST(Validate, SendsSoupsToTheWeld) {
  const TriangleMesh mesh = soup(icosphere(2));
  EXPECT_THAT(kinds(mesh), ElementsAre(DefectKind::duplicate_vertex, DefectKind::open_edge));
  try {
    require_body(mesh, "soup.obj");
    ADD_FAILURE();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
    EXPECT_THAT(error.what(), testing::StartsWith("soup.obj: "));
    EXPECT_THAT(error.what(), HasSubstr("--weld"));
  }
  EXPECT_THAT(kinds(welded(mesh)), IsEmpty());
}

TEST(Validate, TellsOneSidedSurfaces) {
  EXPECT_THAT(kinds(klein_bottle()), ElementsAre(DefectKind::one_sided, DefectKind::self_intersection));
}

TEST(Validate, FindsTrianglesThinnerThanRounding) {
  TriangleMesh mesh = cube(1);
  const TriangleMesh far = moved(stretched(mesh, {1e-14, 1, 1}), {100, 0, 0});
  EXPECT_EQ(kinds(far).front(), DefectKind::degenerate_triangle);
  mesh = make_mesh({{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, 1e-13, 0}},
                   {{0, 2, 4}, {4, 2, 1}, {0, 4, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
  const auto found = kinds(mesh);
  ASSERT_FALSE(found.empty());
  EXPECT_EQ(found.front(), DefectKind::degenerate_triangle);
  EXPECT_THAT(found, Not(testing::Contains(DefectKind::open_edge)));
}

TEST(Validate, SurvivesExtremeCoordinates) {
  EXPECT_EQ(defect_of(stretched(tetrahedron(), Vec3::Constant(1e308))).kind, DefectKind::size_out_of_range);
  EXPECT_EQ(defect_of(stretched(tetrahedron(), Vec3::Constant(1e-300))).kind, DefectKind::size_out_of_range);
  EXPECT_EQ(defect_of(stretched(icosphere(3), Vec3::Zero())).kind, DefectKind::size_out_of_range);
  EXPECT_THAT(kinds(stretched(icosphere(3), {1, 1, 0})), Not(IsEmpty()));
  EXPECT_THAT(kinds(stretched(icosphere(3), {1, 0, 0})), Not(IsEmpty()));
  for (const double size : {1e-50, 1e50, 1e-99, 1e99}) {
    EXPECT_EQ(defect_of(stretched(tetrahedron(), Vec3::Constant(size))).kind, DefectKind::size_out_of_range);
  }
  EXPECT_THAT(kinds(stretched(icosphere(1), Vec3::Constant(1e39))), IsEmpty());
  EXPECT_THAT(kinds(stretched(icosphere(1), Vec3::Constant(1e-39))), IsEmpty());
}

TEST(SelfIntersection, CountsTouchingOverlappingAndFoldedTriangles) {
  // Stacked cubes with equal, and with overlapping faces: contact is an intersection, but not a crossing.
  const TriangleMesh small = moved(stretched(cube(), Vec3::Constant(0.5)), {0.2, 0.3, 1});
  EXPECT_THAT(kinds(joined(cube(), small)), testing::Contains(DefectKind::self_intersection));
  // A corner of one on the face of the other.
  const TriangleMesh tip =
      make_mesh({{0.5, 0.4, 1}, {0, 0, 2}, {1, 0, 2}, {0, 1, 2}}, {{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}});
  EXPECT_THAT(kinds(joined(cube(), tip)), testing::Contains(DefectKind::self_intersection));
  EXPECT_THAT(kinds(joined(cube(), moved(tip, {0, 0, 1e-12}))), Not(testing::Contains(DefectKind::self_intersection)));
  // Neighbours folded onto each other at an edge.
  const TriangleMesh fold = make_mesh({{0, 0, 0}, {1, 0, 0}, {0.2, 1, 0}, {0.7, 0.5, 0}}, {{0, 1, 2}, {1, 0, 3}});
  EXPECT_THAT(kinds(fold), testing::Contains(DefectKind::self_intersection));
  const TriangleMesh unfolded = make_mesh({{0, 0, 0}, {1, 0, 0}, {0.2, 1, 0}, {0.7, -0.5, 0}}, {{0, 1, 2}, {1, 0, 3}});
  EXPECT_THAT(kinds(unfolded), ElementsAre(DefectKind::open_edge));
  // Neighbours at one vertex, in one plane: overlapping and not.
  const auto pair_at_vertex = [](const Vec3& a, const Vec3& b) {
    return make_mesh({{0, 0, 0}, {2, 0, 0}, {0, 2, 0}, a, b}, {{0, 1, 2}, {0, 3, 4}});
  };
  EXPECT_THAT(kinds(pair_at_vertex({1, 0.5, 0}, {0.5, 1, 0})), testing::Contains(DefectKind::self_intersection));
  EXPECT_THAT(kinds(pair_at_vertex({3, 1, 0}, {1, 3, 0})), testing::Contains(DefectKind::self_intersection));
  EXPECT_THAT(kinds(pair_at_vertex({1, 0.5, 1}, {1, 0.5, -1})), testing::Contains(DefectKind::self_intersection));
  EXPECT_THAT(kinds(pair_at_vertex({-1, 0, 0}, {0, -1, 0})), Not(testing::Contains(DefectKind::self_intersection)));
  EXPECT_THAT(kinds(pair_at_vertex({1, 0.5, 1}, {1, 0.5, 2})), Not(testing::Contains(DefectKind::self_intersection)));
}

TEST(SelfIntersection, BecomesAWarningByForceAndNothingElseDoes) {
  const Body body = require_body(self_intersecting_sphere(), "m", {.force = true});
  ASSERT_EQ(body.warnings.size(), 1u);
  EXPECT_EQ(body.warnings.front().kind, DefectKind::self_intersection);
  EXPECT_EQ(body.topology.components, 1);
  EXPECT_THROW(require_body(self_intersecting_sphere(), "m"), Error);
  EXPECT_THROW(require_body(open_cone(), "m", {.force = true}), Error);
}

TEST(SelfIntersection, CountingIsGivenUpOnAThoroughlyBrokenMesh) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> coordinate(0, 1);
  MeshMaker maker;
  for (int t = 0; t < 2000; ++t) {
    std::int32_t v[3];
    for (auto& corner : v) corner = maker.vertex({coordinate(random), coordinate(random), coordinate(random)});
    maker.triangle(v[0], v[1], v[2]);
  }
  const auto defects = find_defects(maker.mesh());
  ASSERT_EQ(defects.back().kind, DefectKind::self_intersection);
  EXPECT_TRUE(defects.back().at_least);
  EXPECT_THAT(message(defects.back()), HasSubstr("at least"));
}

TEST(SelfIntersection, OfTwoTrianglesAgreesWithClippingTheLineOfTheirPlanes) {
  std::mt19937 random(3);
  std::uniform_real_distribution<double> coordinate(0, 1);
  int crossings = 0;
  for (int i = 0; i < 2000; ++i) {
    MeshMaker maker;
    for (int v = 0; v < 6; ++v) maker.vertex({coordinate(random), coordinate(random), coordinate(random)});
    maker.triangle(0, 1, 2);
    maker.triangle(3, 4, 5);
    const TriangleMesh mesh = maker.mesh();
    const Vec3 n0 = area_vector(mesh, 0), n1 = area_vector(mesh, 1), along = n0.cross(n1);
    const auto interval = [&](Index t, const Vec3& n, const Vec3& p) {
      std::array<double, 2> range{1e300, -1e300};
      for (int c = 0; c < 3; ++c) {
        const Vec3 a = mesh.corner(t, c), b = mesh.corner(t, (c + 1) % 3);
        const double da = n.dot(a - p), db = n.dot(b - p);
        if (da * db > 0) continue;
        const double s = along.dot(a + da / (da - db) * (b - a));
        range = {std::min(range[0], s), std::max(range[1], s)};
      }
      return range;
    };
    const auto r0 = interval(0, n1, mesh.corner(1, 0)), r1 = interval(1, n0, mesh.corner(0, 0));
    const bool crossing = std::max(r0[0], r1[0]) <= std::min(r0[1], r1[1]);
    crossings += crossing;
    EXPECT_EQ(find_defects(mesh).back().kind == DefectKind::self_intersection, crossing) << i;
  }
  EXPECT_GT(crossings, 100);
}

TEST(Validate, AcceptsEveryValidSharedMesh) {
  SKINBEM_NEEDS_SHARED_DATA("more_meshes");
  int count = 0;
  for (const char* folder : {"lower_limb", "more_meshes", "reference"}) {
    for (const auto& entry : fs::recursive_directory_iterator(shared_data(folder))) {
      const auto extension = entry.path().extension();
      if ((extension != ".obj" && extension != ".off") || entry.path().parent_path().filename() == "broken") continue;
      const Body body = require_body(read_mesh(entry.path()), entry.path().string());
      EXPECT_EQ(body.topology.cavities, 0);
      EXPECT_EQ(body.topology.genus, entry.path().stem() == "fertility_genus4" ? 4 : 0);
      ++count;
    }
  }
  EXPECT_GE(count, 40);
}

TEST(Validate, JudgesEveryBrokenSharedMeshAsItsReadmeSays) {
  SKINBEM_NEEDS_SHARED_DATA("more_meshes/broken");
  const auto verdict = [](const std::string& name, bool weld = false, bool force = false) {
    const auto path = shared_data("more_meshes/broken") / (name + ".obj");
    try {
      require_body(read_mesh(path, {.weld = weld}), path.filename().string(), {.force = force});
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_input);
      EXPECT_THAT(error.what(), Not(HasSubstr("\n")));
      return std::string(error.what());
    }
    return std::string("accepted");
  };
  for (const char* good : {"valid_reference", "nested_component", "quads_only"}) EXPECT_EQ(verdict(good), "accepted");
  EXPECT_THAT(verdict("open_hole"), HasSubstr("6 open edges"));
  EXPECT_THAT(verdict("nonmanifold_edge"), HasSubstr("1 non-manifold edge"));
  EXPECT_THAT(verdict("flipped_triangle"), HasSubstr("triangle 30"));
  EXPECT_THAT(verdict("inside_out"), HasSubstr("inside out"));
  EXPECT_THAT(verdict("duplicated_vertices"), HasSubstr("--weld"));
  EXPECT_EQ(verdict("duplicated_vertices", true), "accepted");
  EXPECT_THAT(verdict("degenerate_triangle_index"), HasSubstr("twice"));
  EXPECT_THAT(verdict("self_intersection"), HasSubstr("--force"));
  EXPECT_EQ(verdict("self_intersection", false, true), "accepted");
  EXPECT_THAT(verdict("nan_coordinate"), HasSubstr("not finite"));
  EXPECT_THAT(verdict("index_out_of_range"), HasSubstr("vertex 145"));
  EXPECT_THAT(verdict("empty"), HasSubstr("empty"));
  EXPECT_THAT(verdict("binary_garbage"), HasSubstr("binary data"));
  EXPECT_THAT(verdict("unreferenced_vertex"), HasSubstr("vertex 144"));
}

}  // namespace
}  // namespace skinbem
