// SPDX-License-Identifier: BSD-3-Clause
// The files of data/lower_limb as they are shipped.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <map>
#include <numbers>

#include <skinbem/mesh/closest_point.hpp>
#include <skinbem/mesh/mesh_io.hpp>
#include <skinbem/mesh/validate.hpp>

#include "files.hpp"

namespace skinbem {
namespace {

namespace fs = std::filesystem;
using testing_support::project_file;

// Millimetres. The model is built with joint spaces of 2 mm and at least 1 mm of skin over each bone; triangulation and
// rounding may take some of it.
constexpr double least_skin_over_bone = 0.9;
constexpr double least_joint_space = 0.9;
constexpr double least_angle = 15;  // degrees

TriangleMesh skin() { return read_mesh(project_file("data/lower_limb/skin.obj")); }

std::map<std::string, TriangleMesh> bones() {
  std::map<std::string, TriangleMesh> result;
  for (const auto& entry : fs::directory_iterator(project_file("data/lower_limb/bones"))) {
    result.emplace(entry.path().stem().string(), read_mesh(entry.path()));
  }
  return result;
}

double smallest_angle(const TriangleMesh& mesh) {
  double smallest = std::numbers::pi;
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    for (int c = 0; c < 3; ++c) {
      const Vec3 a = mesh.corner(t, (c + 1) % 3) - mesh.corner(t, c);
      const Vec3 b = mesh.corner(t, (c + 2) % 3) - mesh.corner(t, c);
      smallest = std::min(smallest, std::atan2(a.cross(b).norm(), a.dot(b)));
    }
  }
  return smallest * 180 / std::numbers::pi;
}

TEST(LowerLimb, SkinIsABodyOf606VerticesWithoutSlivers) {
  const TriangleMesh mesh = skin();
  EXPECT_EQ(mesh.vertex_count(), 606);
  EXPECT_EQ(mesh.triangle_count(), 1208);
  const Inspection inspection = inspect(mesh);
  EXPECT_TRUE(inspection.defects.empty());
  EXPECT_EQ(inspection.topology.components, 1);
  EXPECT_EQ(inspection.topology.genus, 0);
  EXPECT_GT(smallest_angle(mesh), least_angle);
  EXPECT_GT(volume(mesh), 4e6);  // cubic millimetres: shank and foot of an adult, 4 to 5 litres
  EXPECT_LT(volume(mesh), 5e6);
}

TEST(LowerLimb, SkeletonIs28BodiesOf4797Vertices) {
  Index vertices = 0, triangles = 0;
  for (const auto& [name, mesh] : bones()) {
    vertices += mesh.vertex_count();
    triangles += mesh.triangle_count();
    const Inspection inspection = inspect(mesh);
    EXPECT_TRUE(inspection.defects.empty()) << name;
    EXPECT_EQ(inspection.topology.components, 1) << name;
    EXPECT_EQ(inspection.topology.genus, 0) << name;
    EXPECT_GT(smallest_angle(mesh), least_angle) << name;
  }
  EXPECT_EQ(bones().size(), 28U);
  EXPECT_EQ(vertices, 4797);
  EXPECT_EQ(triangles, 9482);
}

/// The least distance between two surfaces, from the vertices of either to the other.
double distance_between(const SurfaceQuery& a, const SurfaceQuery& b) {
  double least = std::numeric_limits<double>::infinity();
  for (Index i = 0; i < a.mesh().vertex_count(); ++i) {
    least = std::min(least, b.closest(a.mesh().vertices.row(i)).distance);
  }
  for (Index i = 0; i < b.mesh().vertex_count(); ++i) {
    least = std::min(least, a.closest(b.mesh().vertices.row(i)).distance);
  }
  return least;
}

/// One mesh of two surfaces: they cross exactly where it crosses itself.
bool cross(const TriangleMesh& a, const TriangleMesh& b) {
  TriangleMesh both;
  both.vertices.resize(a.vertex_count() + b.vertex_count(), 3);
  both.vertices << a.vertices, b.vertices;
  both.triangles.resize(a.triangle_count() + b.triangle_count(), 3);
  const auto shift = static_cast<Triangles::Scalar>(a.vertex_count());
  both.triangles << a.triangles, (b.triangles.array() + shift).matrix();
  const std::vector<Defect> defects = find_defects(both);
  return std::any_of(defects.begin(), defects.end(),
                     [](const Defect& defect) { return defect.kind == DefectKind::self_intersection; });
}

TEST(LowerLimb, EveryBoneLiesInsideTheSkin) {
  const SurfaceQuery surface(skin());
  for (const auto& [name, mesh] : bones()) {
    for (Index i = 0; i < mesh.vertex_count(); ++i) EXPECT_TRUE(surface.inside(mesh.vertices.row(i))) << name;
    EXPECT_GT(distance_between(SurfaceQuery(mesh), surface), least_skin_over_bone) << name;
    EXPECT_FALSE(cross(mesh, surface.mesh())) << name;
  }
}

TEST(LowerLimb, NoTwoBonesTouch) {
  std::map<std::string, SurfaceQuery> queries;
  for (const auto& [name, mesh] : bones()) queries.emplace(name, mesh);
  for (auto a = queries.begin(); a != queries.end(); ++a) {
    for (auto b = std::next(a); b != queries.end(); ++b) {
      const auto box = [](const SurfaceQuery& query) {
        const Points& points = query.mesh().vertices;
        return Eigen::AlignedBox3d(points.colwise().minCoeff().transpose(), points.colwise().maxCoeff().transpose());
      };
      if (box(a->second).exteriorDistance(box(b->second)) > least_joint_space) continue;
      EXPECT_GT(distance_between(a->second, b->second), least_joint_space) << a->first << ", " << b->first;
      EXPECT_FALSE(a->second.inside(b->second.mesh().vertices.row(0))) << a->first << ", " << b->first;
      EXPECT_FALSE(b->second.inside(a->second.mesh().vertices.row(0))) << a->first << ", " << b->first;
      EXPECT_FALSE(cross(a->second.mesh(), b->second.mesh())) << a->first << ", " << b->first;
    }
  }
}

}  // namespace
}  // namespace skinbem
