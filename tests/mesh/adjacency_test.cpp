// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/mesh/adjacency.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include <skinbem/mesh/weld.hpp>

#include "meshes.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using namespace testing_support;
using testing::ElementsAre;

TEST(Adjacency, ListsTrianglesAndNeighboursAscending) {
  const TriangleMesh mesh = tetrahedron();
  EXPECT_THAT(triangles_around_vertices(mesh)[0], ElementsAre(0, 1, 2));
  EXPECT_THAT(triangles_around_vertices(mesh)[3], ElementsAre(1, 2, 3));
  EXPECT_THAT(neighbours_of_vertices(mesh)[2], ElementsAre(0, 1, 3));
  EXPECT_THAT(neighbours_of_vertices(open_cone(5))[0], ElementsAre(1, 2, 3, 4, 5));
  EXPECT_THAT(neighbours_of_vertices(open_cone(5))[1], ElementsAre(0, 2, 5));
}

TEST(Adjacency, OfAClosedSurfaceHasAsManyNeighboursAsTriangles) {
  const TriangleMesh mesh = torus();
  const IndexLists triangles = triangles_around_vertices(mesh), neighbours = neighbours_of_vertices(mesh);
  ASSERT_EQ(triangles.size(), mesh.vertex_count());
  for (Index v = 0; v < mesh.vertex_count(); ++v) EXPECT_EQ(triangles[v].size(), neighbours[v].size());
}

TEST(Adjacency, MeasuresEdges) {
  const TriangleMesh mesh = stretched(tetrahedron(), {3, 2, 1});
  const IndexLists neighbours = neighbours_of_vertices(mesh);
  EXPECT_DOUBLE_EQ(shortest_edge(mesh, neighbours, 0), 1);
  EXPECT_DOUBLE_EQ(shortest_edge(mesh, neighbours, 1), 3);
  const double sum = 3 + 2 + 1 + std::sqrt(13.0) + std::sqrt(10.0) + std::sqrt(5.0);
  EXPECT_NEAR(mean_edge_length(mesh, neighbours), sum / 6, tolerance::rounding);
  TriangleMesh alone = mesh;
  alone.triangles.resize(0, 3);
  EXPECT_EQ(shortest_edge(alone, neighbours_of_vertices(alone), 0), std::numeric_limits<double>::infinity());
  EXPECT_EQ(mean_edge_length(alone, neighbours_of_vertices(alone)), 0);
}

TEST(Weld, KeepsTheOrderOfFirstAppearanceAndTakesMinusZeroForZero) {
  TriangleMesh mesh = soup(icosphere(2));
  mesh.vertices = (mesh.vertices.array() == 0).select(-mesh.vertices, mesh.vertices);
  const TriangleMesh merged = welded(mesh);
  EXPECT_EQ(merged.vertex_count(), icosphere(2).vertex_count());
  EXPECT_EQ(merged.triangle_count(), mesh.triangle_count());
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    for (int c = 0; c < 3; ++c) EXPECT_EQ(merged.corner(t, c), mesh.corner(t, c));
  }
  EXPECT_THAT(std::vector<std::int32_t>({merged.triangles(0, 0), merged.triangles(0, 1), merged.triangles(0, 2)}),
              ElementsAre(0, 1, 2));
  const Points zeros = (Points(3, 3) << 0.0, 0, 0, -0.0, 0, 0, 1, 0, 0).finished();
  EXPECT_THAT(first_equal_point(zeros), ElementsAre(0, 0, 2));
}

}  // namespace
}  // namespace skinbem
