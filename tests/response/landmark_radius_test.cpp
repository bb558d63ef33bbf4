// SPDX-License-Identifier: BSD-3-Clause
// Landmarks that have a size.
#include <gtest/gtest.h>

#include <skinbem/mesh/adjacency.hpp>
#include <skinbem/response/nearest_point.hpp>
#include <skinbem/response/response_model.hpp>

#include "files.hpp"
#include "reference_data.hpp"
#include "response/bodies.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using namespace testing_support;

const std::vector<std::int32_t> kPlaces = {0, 21, 60, 100};

Eigen::MatrixXd response_of(const TriangleMesh& mesh, const std::vector<Landmark>& landmarks, double tolerance) {
  ResponseModel model(mesh, {0.45, tolerance, {}});
  model.add(landmarks);
  return model.response();
}

TEST(LandmarkRadius, BelowTheShortestEdgeIsAPointLandmark) {
  const TriangleMesh mesh = icosphere(2);
  const IndexLists neighbours = neighbours_of_vertices(mesh);
  std::vector<Landmark> landmarks = landmarks_on(kPlaces);
  for (Landmark& l : landmarks) l.radius = 0.999 * shortest_edge(mesh, neighbours, l.vertex);
  EXPECT_EQ(response_of(mesh, landmarks, 1e-8), response_of(mesh, landmarks_on(kPlaces), 1e-8));
}

TEST(LandmarkRadius, MeasuresTheMeanOfItsPatchWhichFollowsThePrescribedDisplacement) {
  const TriangleMesh mesh = icosphere(2);
  const double radius = 0.6;
  ResponseModel model(mesh, {0.3, 1e-8, {}});
  model.add(landmarks_on(kPlaces, radius));
  const Eigen::MatrixXd R = model.response();
  const Eigen::VectorXd areas = vertex_areas(mesh);
  for (Index k = 0; k < 4; ++k) {
    Eigen::MatrixXd mean = Eigen::MatrixXd::Zero(3, 12);
    double sum = 0;
    for (Index v = 0; v < mesh.vertex_count(); ++v) {
      const double s = (mesh.vertices.row(v) - mesh.vertices.row(kPlaces[k])).norm() / radius;
      if (s >= 1) continue;
      const double weight = (1 - s * s) * (1 - s * s) * areas[v];
      mean += weight * R.middleRows<3>(3 * v);
      sum += weight;
    }
    Eigen::MatrixXd expected = Eigen::MatrixXd::Zero(3, 12);
    expected.middleCols<3>(3 * k).setIdentity();
    EXPECT_LE((mean / sum - expected).cwiseAbs().maxCoeff(), tolerance::rounding_of_sums);
  }
}

TEST(LandmarkRadius, PatchDoesNotJumpToAnotherSideThatIsNear) {
  const TriangleMesh slab = thin_slab(4, 0.05);
  std::vector<Landmark> landmarks;
  for (const Vec3& x : {Vec3(0.25, 0.25, 0), Vec3(0.75, 0.25, 0), Vec3(0.5, 0.75, 0)}) {
    landmarks.push_back(landmarks_on({vertex_at(slab, x)}, 0.2)[0]);  // below the edge 0.25, above the thickness
  }
  ResponseModel model(slab, {0.3, 1e-6, {}});
  model.add(landmarks);
  for (Index k = 0; k < 3; ++k) EXPECT_EQ(model.landmark_positions()(k, 2), 0) << "averages both sides";
}

/// Largest over the columns of the root mean square difference, at the vertices of the coarse leg, between its response
/// and that of the fine one at the nearest places, relative to the fine one's root mean square.
double difference_of_legs(double radius) {
  const TriangleMesh coarse = read_reference_obj(shared_data("lower_limb/skin.obj"));
  const TriangleMesh fine = read_reference_obj(shared_data("lower_limb/skin_2k.obj"));
  const auto rows = read_reference_column(shared_data("lower_limb/landmarks.csv"), "skin_vertex");
  std::vector<std::int32_t> on_coarse, on_fine;
  for (const std::string& row : rows) {
    on_coarse.push_back(std::stoi(row));
    on_fine.push_back(vertex_at(fine, coarse.vertices.row(on_coarse.back())));
  }
  const Eigen::MatrixXd a = response_of(coarse, landmarks_on(on_coarse, radius), 1e-3);
  const Eigen::MatrixXd b = response_of(fine, landmarks_on(on_fine, radius), 1e-3);
  Eigen::MatrixXd at_coarse(a.rows(), a.cols());
  for (Index v = 0; v < coarse.vertex_count(); ++v) {
    const SurfacePoint p = nearest_point(fine, coarse.vertices.row(v));
    at_coarse.middleRows<3>(3 * v).setZero();
    for (int c = 0; c < 3; ++c) {
      at_coarse.middleRows<3>(3 * v) += p.barycentric[c] * b.middleRows<3>(3 * fine.triangles(p.triangle, c));
    }
  }
  return ((a - at_coarse).colwise().norm().array() / at_coarse.colwise().norm().array()).maxCoeff();
}

TEST(LandmarkRadius, MakesTheResponseOfTheLegConvergeWherePointLandmarksDoNot) {
  SKINBEM_NEEDS_SHARED_DATA("lower_limb/skin_2k.obj");
  const double with_radius = difference_of_legs(15), points = difference_of_legs(0);
  RecordProperty("with_radius", std::to_string(with_radius));
  RecordProperty("points", std::to_string(points));
  EXPECT_LE(with_radius, tolerance::leg_of_2k);
  EXPECT_LE(2 * with_radius, points);
}

}  // namespace
}  // namespace skinbem
