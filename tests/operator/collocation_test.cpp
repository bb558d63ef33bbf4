// SPDX-License-Identifier: BSD-3-Clause
// Identities of the assembled double layer on closed meshes, sharp edges and cavities among them.
#include <gtest/gtest.h>
#include <omp.h>

#include <Eigen/Geometry>
#include <skinbem/base/error.hpp>
#include <skinbem/operator/collocation.hpp>

#include "layer_sums.hpp"
#include "meshes.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using namespace testing_support;

struct NamedMesh {
  const char* name;
  TriangleMesh mesh;
};

std::vector<NamedMesh> closed_meshes() {
  return {{"cube", cube(3)},
          {"tetrahedron", tetrahedron()},
          {"square ring", square_ring()},
          {"torus", torus()},
          {"needle box", needle_box(10)},
          {"thin slab", thin_slab(4)},
          {"hollow sphere", hollow_sphere(1)}};
}

class ClosedMeshes : public ::testing::TestWithParam<double> {
 protected:
  Kelvin<double> kernel_{GetParam(), 1.0};
  Eigen::MatrixXd H(const TriangleMesh& mesh) const {
    return Collocation<Kelvin<double>>(mesh, kernel_, {1e-13}).double_layer_matrix();
  }
};

TEST_P(ClosedMeshes, TranslationsAndRotationsAreNullVectors) {
  for (const auto& [name, mesh] : closed_meshes()) {
    const Eigen::MatrixXd matrix = H(mesh);
    for (int k = 0; k < 3; ++k) {
      const auto translation = at_vertices(mesh, [&](const Vec3&) { return Vec3(Vec3::Unit(k)); });
      EXPECT_LE((matrix * translation).cwiseAbs().maxCoeff(), tolerance::rounding_of_sums) << name;
      const auto rotation = at_vertices(mesh, [&](const Vec3& x) { return Vec3(Vec3::Unit(k).cross(x)); });
      EXPECT_LE((matrix * rotation).cwiseAbs().maxCoeff(), tolerance::identity * rotation.cwiseAbs().maxCoeff())
          << name;
    }
  }
}

TEST_P(ClosedMeshes, ConstantStrainIsSolvedExactly) {
  Mat3 F;
  F << 1, 0.6, -0.3, 0.4, -2, 0.7, -0.1, 0.2, 0.4;
  const Mat3 strain = (F + F.transpose()) / 2;
  const double nu = GetParam();
  const Mat3 stress = 2 * nu / (1 - 2 * nu) * strain.trace() * Mat3::Identity() + 2 * strain;
  for (const auto& [name, mesh] : closed_meshes()) {
    const auto u = at_vertices(mesh, [&](const Vec3& x) { return Vec3(F * x); });
    const Eigen::VectorXd load =
        single_layer_at_vertices(mesh, kernel_, [&](Index t, int) { return Vec3(stress * unit_normal(mesh, t)); });
    const double size = std::max(u.cwiseAbs().maxCoeff(), load.cwiseAbs().maxCoeff());
    EXPECT_LE((H(mesh) * u - load).cwiseAbs().maxCoeff(), tolerance::identity * size) << name;
  }
}

INSTANTIATE_TEST_SUITE_P(Poisson, ClosedMeshes, ::testing::Values(0.0, 0.3, 0.45));

TEST(Collocation, BlocksOfTheMatrixEqualTheMatrix) {
  const TriangleMesh mesh = square_ring();
  const Collocation<Kelvin<double>> collocation(mesh, {0.3, 1.0}, {1e-10});
  const Eigen::MatrixXd H = collocation.double_layer_matrix();
  std::vector<std::int32_t> rows, columns;
  for (std::int32_t v = 0; v < mesh.vertex_count(); ++v) {
    if (v % 3 != 1) rows.insert(rows.begin(), v);
    if (v % 4 == 0) columns.push_back(v);
  }
  Eigen::MatrixXd block(3 * Index(rows.size()), 3 * Index(columns.size()));
  collocation.double_layer_block(rows, columns, block);
  for (std::size_t i = 0; i < rows.size(); ++i) {
    for (std::size_t j = 0; j < columns.size(); ++j) {
      const Mat3 entry = block.block<3, 3>(3 * Index(i), 3 * Index(j));
      const Mat3 expected =
          rows[i] == columns[j] ? Mat3(Mat3::Zero()) : Mat3(H.block<3, 3>(3 * rows[i], 3 * columns[j]));
      // other points share the panel, so that another rule of the ladder may serve
      EXPECT_LE((entry - expected).cwiseAbs().maxCoeff(), 1e-10) << rows[i] << ' ' << columns[j];
    }
  }
}

TEST(Collocation, SingleLayerOfSeveralVerticesIsTheSumOfTheirColumns) {
  const Collocation<Kelvin<double>> collocation(cube(2), {0.3, 1.0}, {1e-12});
  const VertexWeight both[] = {{3, 0.5}, {7, -2.0}};
  Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(3 * collocation.node_count(), 3);
  for (const VertexWeight& w : both) {
    const VertexWeight one{w.vertex, 1.0};
    sum += w.value * collocation.single_layer_columns(std::span(&one, 1));
  }
  EXPECT_LE((collocation.single_layer_columns(both) - sum).cwiseAbs().maxCoeff(), 1e-12);
}

TEST(Collocation, SingleLayerOfAPieceIsItsShareOfTheTriangles) {
  const TriangleMesh mesh = cube(2);
  const Collocation<Kelvin<double>> collocation(mesh, {0.3, 1.0}, {1e-12});
  const Vec3 density(1, -2, 0.5);
  const LoadedPiece whole{7, Mat3::Identity(), density};
  Mat3 halves[2];  // cut from corner 2 to the middle of the side opposite
  halves[0] << 1, 0.5, 0, 0, 0.5, 0, 0, 0, 1;
  halves[1] << 0.5, 0, 0, 0.5, 1, 0, 0, 0, 1;
  std::vector<LoadedPiece> pieces;
  for (const Mat3& corners : halves) pieces.push_back({7, corners, corners.transpose() * density});
  const Eigen::MatrixXd expected = collocation.single_layer_columns(std::span(&whole, 1));
  EXPECT_LE((collocation.single_layer_columns(pieces) - expected).cwiseAbs().maxCoeff(), 1e-12);
  EXPECT_LE((loads_of_vertices(mesh, pieces) - loads_of_vertices(mesh, std::span(&whole, 1))).norm(),
            tolerance::rounding);
  EXPECT_NEAR(loads_of_triangles(mesh, pieces)[7], density.mean() * area_vector(mesh, 7).norm() / 2,
              tolerance::rounding);
}

class Threads : public ::testing::TestWithParam<int> {
 protected:
  void SetUp() override { omp_set_num_threads(GetParam()); }
  void TearDown() override { omp_set_num_threads(before_); }
  int before_ = omp_get_max_threads();
};

TEST_P(Threads, DoNotChangeABit) {
  const Collocation<Kelvin<double>> collocation(torus(), {0.3, 1.0}, {1e-8});
  const VertexWeight hat{5, 1.0};
  const Eigen::MatrixXd H = collocation.double_layer_matrix();
  const Eigen::MatrixXd G = collocation.single_layer_columns(std::span(&hat, 1));
  omp_set_num_threads(1);
  const Eigen::MatrixXd alone = collocation.double_layer_matrix();
  EXPECT_TRUE((H.array() == alone.array()).all());
  EXPECT_TRUE((G.array() == collocation.single_layer_columns(std::span(&hat, 1)).array()).all());
}

INSTANTIATE_TEST_SUITE_P(Count, Threads, ::testing::Values(2, 3));

TEST(Collocation, RefusesATriangleWithoutAreaByName) {
  TriangleMesh mesh = cube(2);
  mesh.vertices.row(mesh.triangles(5, 0)) = mesh.vertices.row(mesh.triangles(5, 1));
  try {
    const Collocation<Kelvin<double>> collocation(mesh, {0.3, 1.0});
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
    EXPECT_NE(std::string(error.what()).find("has no area"), std::string::npos);
  }
}

TEST(Collocation, CanBeCancelled) {
  const Collocation<Kelvin<double>> collocation(cube(4), {0.3, 1.0});
  omp_set_num_threads(1);  // of several, the one that reports may find no work left
  try {
    collocation.double_layer_matrix([](std::string_view, double) { return false; });
    FAIL() << "ran to its end";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
}

}  // namespace
}  // namespace skinbem
