// SPDX-License-Identifier: BSD-3-Clause
// What must not change the response, and what it must do to rigid motions.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <numeric>
#include <random>
#include <skinbem/response/response_model.hpp>

#include "response/bodies.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using namespace testing_support;

constexpr double kPrecise = 1e-11;

Eigen::MatrixXd response_of(const TriangleMesh& mesh, const std::vector<Landmark>& landmarks, double nu = 0.45) {
  ResponseModel model(mesh, {nu, kPrecise, {}});
  model.add(landmarks);
  return model.response();
}

/// A body without symmetry.
TriangleMesh potato() {
  TriangleMesh mesh = icosphere(2);
  for (Index v = 0; v < mesh.vertex_count(); ++v) {
    auto p = mesh.vertices.row(v);
    p *= 1 + 0.2 * std::sin(2 * p[0] + p[1]) + 0.1 * p[2];
  }
  return stretched(mesh, {1, 1.4, 0.8});
}

const std::vector<std::int32_t> kPlaces = {3, 40, 77, 120};

class Invariance : public ::testing::TestWithParam<double> {  // the landmarks' radius, mesh of size 2
 protected:
  double radius_ = GetParam();
  TriangleMesh mesh_ = potato();
  std::vector<Landmark> landmarks_ = landmarks_on(kPlaces, radius_);
  Eigen::MatrixXd R_ = response_of(mesh_, landmarks_);

  void expect_same(const Eigen::MatrixXd& R, double factor = 1) const {
    EXPECT_LE((R - R_).cwiseAbs().maxCoeff(), factor * tolerance::invariance * R_.cwiseAbs().maxCoeff());
  }
};

TEST_P(Invariance, UnderUniformScale) {
  for (const double scale : {1e-3, 0.7, 25.4, 1e3}) {
    expect_same(response_of(stretched(mesh_, Vec3::Constant(scale)), landmarks_on(kPlaces, scale * radius_)));
  }
}

TEST_P(Invariance, UnderTranslation) { expect_same(response_of(moved(mesh_, {10, -20, 5}), landmarks_), 10); }

TEST_P(Invariance, UnderRotationOfBodyAndDisplacements) {
  const Mat3 Q = (Eigen::AngleAxisd(1.1, Vec3(1, 2, -1).normalized())).toRotationMatrix();
  TriangleMesh turned = mesh_;
  turned.vertices = mesh_.vertices * Q.transpose();
  Eigen::MatrixXd R = response_of(turned, landmarks_);
  for (Index i = 0; i < R.rows(); i += 3) R.middleRows<3>(i) = Q.transpose() * R.middleRows<3>(i).eval();
  for (Index k = 0; k < R.cols(); k += 3) R.middleCols<3>(k) = R.middleCols<3>(k).eval() * Q;
  expect_same(R);
}

TEST_P(Invariance, UnderRenumberingOfVerticesTrianglesAndLandmarks) {
  std::mt19937 random(11);
  std::vector<std::int32_t> new_number(mesh_.vertex_count()), new_triangle(mesh_.triangle_count());
  std::iota(new_number.begin(), new_number.end(), 0);
  std::iota(new_triangle.begin(), new_triangle.end(), 0);
  std::shuffle(new_number.begin(), new_number.end(), random);
  std::shuffle(new_triangle.begin(), new_triangle.end(), random);
  TriangleMesh renumbered = mesh_;
  for (Index v = 0; v < mesh_.vertex_count(); ++v) renumbered.vertices.row(new_number[v]) = mesh_.vertices.row(v);
  for (Index t = 0; t < mesh_.triangle_count(); ++t) {
    for (int c = 0; c < 3; ++c) renumbered.triangles(new_triangle[t], (c + t) % 3) = new_number[mesh_.triangles(t, c)];
  }
  std::vector<std::int32_t> places;
  for (const int k : {2, 0, 3, 1}) places.push_back(new_number[kPlaces[k]]);
  const Eigen::MatrixXd R = response_of(renumbered, landmarks_on(places, radius_));
  Eigen::MatrixXd back(R.rows(), R.cols());
  const int order[] = {2, 0, 3, 1};
  for (Index v = 0; v < mesh_.vertex_count(); ++v) {
    for (int k = 0; k < 4; ++k) back.block<3, 3>(3 * v, 3 * order[k]) = R.block<3, 3>(3 * new_number[v], 3 * k);
  }
  expect_same(back);
}

TEST_P(Invariance, RigidMotionsOfTheLandmarksMoveTheWholeBodyRigidly) {
  ResponseModel model(mesh_, {0.45, 1e-3, {}});  // by construction, whatever the tolerance
  model.add(landmarks_);
  const auto motion = [](const Vec3& x) { return Vec3(Vec3(0.3, -1, 2) + Vec3(0.5, 0.2, -0.7).cross(x)); };
  Eigen::VectorXd prescribed(12), expected(3 * mesh_.vertex_count());
  for (Index k = 0; k < 4; ++k) prescribed.segment<3>(3 * k) = motion(model.landmark_positions().row(k));
  for (Index v = 0; v < mesh_.vertex_count(); ++v) expected.segment<3>(3 * v) = motion(mesh_.vertices.row(v));
  EXPECT_LE((model.response() * prescribed - expected).cwiseAbs().maxCoeff(), tolerance::rounding_of_sums);
}

TEST_P(Invariance, TractionsScaleWithTheInverseOfLength) {
  ResponseModel model(mesh_, {0.45, kPrecise, {}}), large(stretched(mesh_, Vec3::Constant(50)), {0.45, kPrecise, {}});
  model.add(landmarks_);
  large.add(landmarks_on(kPlaces, 50 * radius_));
  const Eigen::MatrixXd T = model.tractions();
  EXPECT_LE((50 * large.tractions() - T).cwiseAbs().maxCoeff(), tolerance::invariance * T.cwiseAbs().maxCoeff());
}

INSTANTIATE_TEST_SUITE_P(Radius, Invariance, ::testing::Values(0.0, 0.6));

/// What each landmark's displacement, times the load that its patch carries, does for the other: (C - C^T) / C, where
/// C's entries are work-conjugate. Falls with the mesh: reciprocity (Betti) holds for the continuous problem only.
double asymmetry(int level) {
  const TriangleMesh mesh = ellipsoid(level, {1, 1.5, 0.8});
  ResponseModel model(mesh, {0.45, 1e-8, {}});
  std::vector<std::int32_t> places;
  for (const Vec3& x : {Vec3(1, 0, 0), Vec3(0, 1.5, 0), Vec3(0, 0, 0.8), Vec3(-1, 0, 0)}) {
    places.push_back(vertex_at(mesh, x));
  }
  model.add(landmarks_on(places, 0.7));
  // forces of the patches, up to a factor that tends to the same for all
  Eigen::MatrixXd F = model.tractions();
  for (std::size_t k = 0; k < places.size(); ++k) {
    double load = 0;
    const Eigen::VectorXd areas = vertex_areas(mesh);
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const double s = (mesh.vertices.row(v) - mesh.vertices.row(places[k])).norm() / 0.7;
      if (s < 1) load += (1 - s * s) * (1 - s * s) * areas[v];
    }
    F.middleRows<3>(3 * Index(k)) *= load;
  }
  return (F - F.transpose()).cwiseAbs().maxCoeff() / F.cwiseAbs().maxCoeff();
}

TEST(Reciprocity, ForcesOfLandmarksAreSymmetricUpToTheDiscretisationAndImproveWithTheMesh) {
  const double coarse = asymmetry(1), middle = asymmetry(2), fine = asymmetry(3);
  RecordProperty("asymmetry", std::to_string(coarse) + ' ' + std::to_string(middle) + ' ' + std::to_string(fine));
  EXPECT_LE(middle, coarse);
  EXPECT_LE(fine, middle / std::pow(2, tolerance::observed_order));
  EXPECT_LE(fine, tolerance::reciprocity);
}

}  // namespace
}  // namespace skinbem
