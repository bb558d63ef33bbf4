// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <skinbem/response/response_model.hpp>
#include <skinbem/solve/rigid_modes.hpp>

#include "meshes.hpp"
#include "tetrahedral_fem.hpp"
#include "tolerances.hpp"

namespace skinbem::bench {
namespace {

using namespace testing_support;

std::vector<Landmark> landmarks_at(const TriangleMesh& mesh, const std::vector<Vec3>& places, double radius) {
  std::vector<Landmark> landmarks;
  for (const Vec3& place : places) {
    Landmark landmark{.name = std::to_string(landmarks.size()), .radius = radius};
    (mesh.vertices.rowwise() - place.transpose()).rowwise().squaredNorm().minCoeff(&landmark.vertex);
    landmarks.push_back(landmark);
  }
  return landmarks;
}

Eigen::MatrixXd without_rigid(const TriangleMesh& mesh, const Eigen::MatrixXd& u) {
  const Eigen::MatrixXd B = rigid_modes(mesh.vertices);
  return u - B * (B.transpose() * u);
}

TEST(TetrahedralFem, SolvesConstantStrainExactly) {
  for (const double nu : {0.0, 0.3, 0.49}) {
    const TriangleMesh mesh = square_ring();
    Mat3 strain;
    strain << 1, 0.5, -0.3, 0.5, -2, 0.7, -0.3, 0.7, 0.4;
    const Mat3 stress = 2 * nu / (1 - 2 * nu) * strain.trace() * Mat3::Identity() + 2 * strain;
    Points forces = Points::Zero(mesh.vertex_count(), 3);
    for (Index t = 0; t < mesh.triangle_count(); ++t) {
      for (int c = 0; c < 3; ++c) forces.row(mesh.triangles(t, c)) += (stress * area_vector(mesh, t)).transpose() / 6;
    }
    const Points exact = mesh.vertices * strain;
    const auto as_column = [](const Points& field) { return field.reshaped<Eigen::RowMajor>(); };
    const Eigen::MatrixXd difference =
        without_rigid(mesh, TetrahedralFem(mesh, {.poisson = nu}).displacements(as_column(forces)) - as_column(exact));
    EXPECT_LE(difference.cwiseAbs().maxCoeff(), tolerance::finite_elements * exact.cwiseAbs().maxCoeff()) << nu;
  }
}

TEST(TetrahedralFem, ReproducesRigidMotionsOfTheLandmarks) {
  const TriangleMesh mesh = slender_ellipsoid(2);
  for (const double radius : {0.0, 0.8}) {
    const auto landmarks = landmarks_at(mesh, {{6, 0, 0}, {-6, 0, 0}, {0, 1, 0}, {0, 0, 1}}, radius);
    const Eigen::MatrixXd R = TetrahedralFem(mesh).response(landmarks);
    ResponseModel model(mesh, {.tolerance = 1e-3});
    model.add(landmarks);
    const Points places = model.landmark_positions();
    const Vec3 turn(0.3, -0.2, 0.5), shift(1, 2, 3);
    const auto moved = [&](const Points& points) {
      Points u = points;
      for (Index i = 0; i < u.rows(); ++i) u.row(i) = turn.cross(Vec3(points.row(i))) + shift;
      return Eigen::VectorXd(u.reshaped<Eigen::RowMajor>());
    };
    EXPECT_LE((R * moved(places) - moved(mesh.vertices)).cwiseAbs().maxCoeff(), tolerance::finite_elements);
  }
}

TEST(TetrahedralFem, ApproachesTheBoundaryElementsOnASphere) {
  double before = 0;
  for (const int level : {2, 3}) {
    const TriangleMesh mesh = icosphere(level);
    const auto landmarks = landmarks_at(mesh, {{1, 0, 0}, {-1, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 0.6);
    ResponseModel model(mesh, {.poisson = 0.3, .tolerance = 1e-4});
    model.add(landmarks);
    const Eigen::MatrixXd R = model.response();
    const double difference = (TetrahedralFem(mesh, {.poisson = 0.3}).response(landmarks) - R).norm() / R.norm();
    if (before > 0) {
      EXPECT_LE(difference, tolerance::finite_against_boundary_elements);
      EXPECT_GE(std::log2(before / difference), 1.0);
    }
    before = difference;
  }
}

}  // namespace
}  // namespace skinbem::bench
