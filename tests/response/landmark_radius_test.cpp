// SPDX-License-Identifier: BSD-3-Clause
// Landmarks that have a size.
#include <gtest/gtest.h>

#include <skinbem/mesh/adjacency.hpp>
#include <skinbem/response/response_model.hpp>

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

}  // namespace
}  // namespace skinbem
