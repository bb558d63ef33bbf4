// SPDX-License-Identifier: BSD-3-Clause
// Landmarks that have a size.
#include <gtest/gtest.h>

#include <numbers>
#include <skinbem/mesh/adjacency.hpp>
#include <skinbem/mesh/closest_point.hpp>
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

TEST(LandmarkRadius, SoLargeThatAllShareOnePatchIsRefused) {
  const TriangleMesh mesh = icosphere(2);
  EXPECT_NO_THROW(response_of(mesh, landmarks_on(kPlaces, 5), 1e-6));
  for (const double radius : {3e3, 1e5, 1e9, 1e200}) {
    EXPECT_THROW(response_of(mesh, landmarks_on(kPlaces, radius), 1e-6), Error) << radius;
  }
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

/// |R_h - R_(h/2)| / |R_(h/2)| at the vertices that two spheres share, 162 and 642 vertices.
double change_by_refinement(double radius) {
  const std::vector<Landmark> landmarks = landmarks_on({0, 3, 5, 9}, radius);
  const Eigen::MatrixXd coarse = response_of(icosphere(2), landmarks, 1e-4);
  const Eigen::MatrixXd fine = response_of(icosphere(3), landmarks, 1e-4).topRows(coarse.rows());
  return (fine - coarse).norm() / fine.norm();
}

TEST(LandmarkRadius, MakesTheResponseConvergeWherePointLandmarksDoNot) {
  const double with_radius = change_by_refinement(0.8), points = change_by_refinement(0);
  EXPECT_LE(with_radius, tolerance::refined_sphere);
  EXPECT_LE(5 * with_radius, points);
}

/// Root mean square over skin and columns of the difference between the responses of the real leg with 606 and with
/// 2,000 vertices (there taken at the place nearest to the coarse vertex), relative to the finer one.
double difference_of_legs(double radius) {
  const TriangleMesh coarse = read_reference_obj(shared_data("lower_limb/skin.obj"));
  const TriangleMesh fine = read_reference_obj(shared_data("lower_limb/skin_2k.obj"));
  std::vector<std::int32_t> on_coarse, on_fine;
  for (const std::string& row : read_reference_column(shared_data("lower_limb/landmarks.csv"), "skin_vertex")) {
    on_coarse.push_back(std::stoi(row));
    on_fine.push_back(vertex_at(fine, coarse.vertices.row(on_coarse.back())));
  }
  const Eigen::MatrixXd a = response_of(coarse, landmarks_on(on_coarse, radius), 1e-3);
  const Eigen::MatrixXd b = response_of(fine, landmarks_on(on_fine, radius), 1e-3);
  const SurfaceQuery surface(fine);
  Eigen::MatrixXd at_coarse = Eigen::MatrixXd::Zero(a.rows(), a.cols());
  for (Index v = 0; v < coarse.vertex_count(); ++v) {
    const SurfacePoint p = surface.closest(coarse.vertices.row(v));
    for (int c = 0; c < 3; ++c) {
      at_coarse.middleRows<3>(3 * v) += p.barycentric[c] * b.middleRows<3>(3 * fine.triangles(p.triangle, c));
    }
  }
  return (a - at_coarse).norm() / at_coarse.norm();
}

TEST(LandmarkRadius, BringsTheRealLegOf606VerticesCloserToThatOf2000) {
  SKINBEM_NEEDS_SHARED_DATA("lower_limb/skin_2k.obj");
  // wider than the edges of the coarse shank, 26 mm: below them a landmark is a point there and a patch on the finer
  // leg
  const double with_radius = difference_of_legs(45), points = difference_of_legs(0);
  EXPECT_LE(with_radius, tolerance::leg_of_2k);
  EXPECT_LE(with_radius, 0.8 * points);
}

LandmarkPatch smooth_patch(const TriangleMesh& mesh, std::int32_t vertex, double radius) {
  return make_patch(mesh, triangles_around_vertices(mesh), vertex_areas(mesh), landmarks_on({vertex}, radius)[0],
                    Loads::smooth);
}

TEST(SmoothLoads, HaveTheIntegralOfPhiOnTrianglesOfAnySize) {
  const TriangleMesh mesh = cube(4);
  const std::int32_t middle = vertex_at(mesh, {0.5, 0.5, 1});
  for (const double radius : {0.01, 0.1, 0.24, 0.3, 0.5}) {
    const LandmarkPatch patch = smooth_patch(mesh, middle, radius);
    const double expected = std::numbers::pi * radius * radius / 3;
    EXPECT_NEAR(loads_of_vertices(mesh, patch.traction).sum(), expected, tolerance::smooth_load * expected) << radius;
    EXPECT_NEAR(loads_of_triangles(mesh, patch.traction).sum(), expected, tolerance::smooth_load * expected) << radius;
    EXPECT_LE((patch.measure(mesh.vertices) - Vec3(0.5, 0.5, 1)).norm(), tolerance::smooth_load * radius) << radius;
    double sum = 0;
    for (const VertexWeight& w : patch.measurement) sum += w.value;
    EXPECT_NEAR(sum, 1, tolerance::rounding);
  }
}

TEST(SmoothLoads, StayOnTheirSideOfASlab) {
  const TriangleMesh slab = thin_slab(4, 0.05);
  const LandmarkPatch patch = smooth_patch(slab, vertex_at(slab, {0.5, 0.5, 0}), 0.2);
  for (const LoadedPiece& piece : patch.traction) {
    for (int c = 0; c < 3; ++c) EXPECT_EQ(slab.corner(piece.triangle, c)[2], 0);
  }
}

TEST(SmoothLoads, OfPointsAndOfNearPointsAreLinearOnes) {
  const TriangleMesh mesh = cube(3);
  for (const double radius : {0.0, 1e-300, 1e-5}) {
    const LandmarkPatch patch = smooth_patch(mesh, 30, radius);
    ASSERT_EQ(patch.measurement.size(), 1u);
    EXPECT_EQ(patch.measurement[0].vertex, 30);
    EXPECT_NEAR(loads_of_vertices(mesh, patch.traction).sum(), vertex_areas(mesh)[30], tolerance::rounding);
  }
}

/// Landmarks that are smaller than the triangles of the coarser of two meshes of one cube.
TEST(SmoothLoads, MakeTheResponseDependLessOnTheMesh) {
  const std::vector<Vec3> places = {{0.5, 0.5, 1}, {0, 0.5, 0.5}, {0.5, 0, 0.5}, {1, 0.5, 0.5}};
  const auto change = [&](Loads loads) {
    Eigen::MatrixXd at_places[2];
    for (int k = 0; k < 2; ++k) {
      const TriangleMesh mesh = cube(k == 0 ? 4 : 8);
      std::vector<std::int32_t> vertices;
      for (const Vec3& place : places) vertices.push_back(vertex_at(mesh, place));
      ResponseModel model(mesh, {.tolerance = 1e-4, .loads = loads});
      model.add(landmarks_on(vertices, 0.24));
      const Eigen::MatrixXd R = model.response();
      at_places[k].resize(24, R.cols());
      for (int corner = 0; corner < 8; ++corner) {
        const std::int32_t v = vertex_at(mesh, Vec3(corner & 1, corner >> 1 & 1, corner >> 2));
        at_places[k].middleRows<3>(3 * corner) = R.middleRows<3>(3 * v);
      }
    }
    return (at_places[1] - at_places[0]).norm() / at_places[1].norm();
  };
  EXPECT_LE(3 * change(Loads::smooth), change(Loads::linear)) << change(Loads::smooth) << ' ' << change(Loads::linear);
}

TEST(Cavity, IsRefusedCloseToIncompressible) {
  const TriangleMesh body = hollow_sphere(1);
  EXPECT_NO_THROW(ResponseModel(body, {0.49, 1e-3, {}}));
  for (const double poisson : {0.495, 0.5}) {
    try {
      ResponseModel model(body, {poisson, 1e-3, {}});
      ADD_FAILURE() << poisson;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_input);
    }
  }
}

}  // namespace
}  // namespace skinbem
