// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/frame/normals.hpp>

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>

#include <skinbem/base/error.hpp>
#include <skinbem/frame/frame_model.hpp>

#include "meshes.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using testing_support::icosphere;

std::vector<float> floats_of(const Points& points) {
  return std::vector<float>(points.data(), points.data() + points.size());
}

Points points_of(const std::vector<float>& floats) {
  Points points(static_cast<Index>(floats.size()) / 3, 3);
  for (Index i = 0; i < points.size(); ++i) points.data()[i] = double{floats[static_cast<std::size_t>(i)]};
  return points;
}

Points exact_normals(const Points& positions, const Triangles& triangles) {
  VertexNormals normals(triangles, positions.rows());
  const std::vector<float> from = floats_of(positions);
  std::vector<float> to(from.size());
  EXPECT_TRUE(normals.evaluate({from}, {to}));
  return points_of(to);
}

TEST(VertexNormals, PointOutwardFromASphereAndHaveLengthOne) {
  const TriangleMesh sphere = icosphere(3);
  const Points normals = exact_normals(sphere.vertices, sphere.triangles);
  EXPECT_LE((normals - sphere.vertices).cwiseAbs().maxCoeff(), 0.02);  // flat triangles, edges of 0.15
  EXPECT_LE((normals.rowwise().norm().array() - 1).abs().maxCoeff(), tolerance::frame_rigid);
}

TEST(VertexNormals, GoIntoTheBufferOfThePositions) {
  const TriangleMesh sphere = icosphere(1);
  const Points expected = exact_normals(sphere.vertices, sphere.triangles);
  const auto vertices = static_cast<std::size_t>(sphere.vertex_count());
  std::vector<float> buffer(6 * vertices, 0.0F);
  for (std::size_t i = 0; i < vertices; ++i) {
    for (std::size_t c = 0; c < 3; ++c) buffer[6 * i + c] = static_cast<float>(sphere.vertices(Index(i), Index(c)));
  }
  VertexNormals normals(sphere.triangles, sphere.vertex_count());
  ASSERT_TRUE(normals.evaluate({buffer, 0, 6}, {buffer, 3, 6}));
  for (std::size_t i = 0; i < vertices; ++i) {
    for (std::size_t c = 0; c < 3; ++c) {
      EXPECT_EQ(buffer[6 * i + c], static_cast<float>(sphere.vertices(Index(i), Index(c))));
      EXPECT_EQ(buffer[6 * i + 3 + c], static_cast<float>(expected(Index(i), Index(c))));
    }
  }
  EXPECT_FALSE(normals.evaluate({buffer, 0, 6}, {buffer, 4, 6}));
}

TEST(VertexNormals, AreZeroWhereTrianglesVanish) {
  const TriangleMesh sphere = icosphere(1);
  EXPECT_EQ(exact_normals(Points::Zero(sphere.vertex_count(), 3), sphere.triangles).cwiseAbs().maxCoeff(), 0);
  EXPECT_THROW(VertexNormals(sphere.triangles, 3), Error);
}

/// Displacements that bend the sphere smoothly: columns are smooth fields.
Eigen::MatrixXd smooth_response(const Points& rest, Index columns) {
  std::srand(11);
  Eigen::MatrixXd response(3 * rest.rows(), columns);
  for (Index k = 0; k < columns; ++k) {
    const Points wave = Points::Random(3, 3) * 2;
    for (Index i = 0; i < rest.rows(); ++i) {
      response.block<3, 1>(3 * i, k) = (wave * rest.row(i).transpose()).array().sin().matrix();
    }
  }
  return response;
}

TEST(LinearNormals, AgreeWithTheExactOnesToFirstOrder) {
  const TriangleMesh sphere = icosphere(2);
  const Eigen::MatrixXd response = smooth_response(sphere.vertices, 9);
  const LinearNormals linear = linear_normals(sphere.vertices, sphere.triangles, response);
  EXPECT_LE((linear.rest - exact_normals(sphere.vertices, sphere.triangles)).cwiseAbs().maxCoeff(),
            tolerance::frame_rigid);
  const Eigen::VectorXd q = Eigen::VectorXd::Random(9);
  // In double, from the rest normals of the deformed sphere.
  const auto error_at = [&](double size) {
    const Eigen::VectorXd moved = size * (response * q);
    const Eigen::VectorXd turned = size * (linear.response * q);
    const Points deformed = sphere.vertices + Eigen::Map<const Points>(moved.data(), sphere.vertex_count(), 3);
    const Points exact = linear_normals(deformed, sphere.triangles, response).rest;
    const Points found = linear.rest + Eigen::Map<const Points>(turned.data(), sphere.vertex_count(), 3);
    return (found - exact).cwiseAbs().maxCoeff();
  };
  EXPECT_LE(error_at(1e-3), error_at(1e-2) / 80);
}

TEST(LinearNormals, TurnWithTheBodyAndDoNotShift) {
  const TriangleMesh sphere = testing_support::moved(icosphere(2), {5, 6, 7});
  const Points landmarks = sphere.vertices.topRows(3);
  const LinearNormals linear = linear_normals(sphere.vertices, sphere.triangles, smooth_response(sphere.vertices, 9));
  FrameOptions options;
  options.directions = true;
  const FrameModel model(linear.rest, linear.response, landmarks, options);
  FrameState state(model);
  BodyMotion motion = BodyMotion::at_rest(3);
  motion.rigid = {Eigen::AngleAxisd(1, Vec3::UnitZ()).toRotationMatrix(), {10, 20, 30}};
  ASSERT_TRUE(state.set_motion(motion));
  std::vector<float> found(static_cast<std::size_t>(3 * model.vertex_count()));
  ASSERT_TRUE(state.evaluate(found));
  const Points expected = linear.rest * motion.rigid.rotation.transpose();
  EXPECT_LE((points_of(found) - expected).cwiseAbs().maxCoeff(), tolerance::frame_rigid);
  motion.weights(1) = std::numeric_limits<double>::infinity();
  EXPECT_FALSE(state.set_motion(motion));
  EXPECT_FALSE(state.set_motion(BodyMotion::at_rest(4)));
}

TEST(LinearNormals, RefuseShapesThatDoNotFit) {
  const TriangleMesh sphere = icosphere(1);
  EXPECT_THROW(linear_normals(sphere.vertices, sphere.triangles, Eigen::MatrixXd::Zero(5, 3)), Error);
  EXPECT_THROW(linear_normals(sphere.vertices.topRows(5), sphere.triangles, Eigen::MatrixXd::Zero(15, 3)), Error);
  EXPECT_THROW(linear_normals(Points::Zero(sphere.vertex_count(), 3), sphere.triangles,
                              Eigen::MatrixXd::Zero(3 * sphere.vertex_count(), 3)),
               Error);
}

}  // namespace
}  // namespace skinbem
