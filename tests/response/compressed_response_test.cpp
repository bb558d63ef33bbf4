// SPDX-License-Identifier: BSD-3-Clause
// The response by the compressed matrix against the dense one: to its tolerance, and no worse than it says.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <skinbem/base/error.hpp>
#include <skinbem/mesh/mesh_io.hpp>
#include <skinbem/response/response_model.hpp>
#include <skinbem/solve/neumann_solver.hpp>

#include "files.hpp"
#include "response/bodies.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using namespace testing_support;

struct CompressedCase {
  const char* name;
  TriangleMesh (*make)();
  const char* shared = nullptr;  ///< file of the shared data, in place of `make`
};

/// Vertices far from each other.
std::vector<std::int32_t> spread_vertices(const TriangleMesh& mesh, int count) {
  std::vector<std::int32_t> chosen = {0};
  Eigen::VectorXd distance2 = Eigen::VectorXd::Constant(mesh.vertex_count(), std::numeric_limits<double>::infinity());
  while (int(chosen.size()) < count) {
    const Eigen::RowVector3d last = mesh.vertices.row(chosen.back());
    distance2 = distance2.cwiseMin((mesh.vertices.rowwise() - last).rowwise().squaredNorm());
    Index farthest = 0;
    distance2.maxCoeff(&farthest);
    chosen.push_back(std::int32_t(farthest));
  }
  return chosen;
}

ResponseModel model(const TriangleMesh& mesh, double requested, Solver solver) {
  ResponseModel made(mesh, {.poisson = 0.45, .tolerance = requested, .solver = solver});
  made.add(landmarks_on(spread_vertices(mesh, 5)));
  return made;
}

double difference(const ResponseModel& found, const ResponseModel& expected) {
  const Eigen::MatrixXd R = expected.response();
  return (found.response() - R).cwiseAbs().maxCoeff() / R.cwiseAbs().maxCoeff();
}

class CompressedResponse : public ::testing::TestWithParam<CompressedCase> {};

TEST_P(CompressedResponse, MeetsItsToleranceAndItsEstimate) {
  if (GetParam().shared) SKINBEM_NEEDS_SHARED_DATA(GetParam().shared);
  const TriangleMesh mesh = GetParam().shared ? read_mesh(shared_data(GetParam().shared)) : GetParam().make();
  const ResponseModel dense = model(mesh, 1e-5, Solver::dense);
  for (const double requested : {1e-3, 2e-4}) {
    const ResponseModel compressed = model(mesh, requested, Solver::hmatrix);
    const double error = difference(compressed, dense);
    EXPECT_LE(error, tolerance::compressed_response * requested) << requested;
    EXPECT_LE(error, tolerance::compressed_estimate * compressed.summary().estimated_error) << requested;
    EXPECT_LE(compressed.summary().estimated_error, 1.5 * requested) << requested;
  }
}

INSTANTIATE_TEST_SUITE_P(
    Bodies, CompressedResponse,
    ::testing::Values(CompressedCase{"cube", [] { return cube(12); }},
                      CompressedCase{"slab", [] { return thin_slab(20, 0.04); }},
                      CompressedCase{"ellipsoid", [] { return slender_ellipsoid(4); }},
                      CompressedCase{"torus", [] { return torus(1, 0.3, 48, 24); }},
                      CompressedCase{"hollow", [] { return hollow_sphere(3); }},
                      CompressedCase{"spiked", [] { return spiked_sphere(4, 6); }},
                      CompressedCase{"needle", [] { return needle_box(120); }},
                      CompressedCase{"leg", [] { return read_mesh(project_file("data/lower_limb/skin.obj")); }},
                      CompressedCase{"bunny", nullptr, "more_meshes/bunny.off"},
                      CompressedCase{"spot", nullptr, "more_meshes/spot.obj"}),
    [](const auto& body) { return body.param.name; });

/// How often everything is solved for while landmarks are added: progress starts anew.
int solves(const TriangleMesh& mesh, double requested, ResponseSummary& summary) {
  int starts = 0;
  double last = 2;
  ResponseOptions options{.poisson = 0.45, .tolerance = requested, .solver = Solver::hmatrix};
  options.progress = [&](std::string_view stage, double done) {
    if (stage != "solve") return true;
    starts += done < last;
    last = done;
    return true;
  };
  ResponseModel made(mesh, options);
  made.add(landmarks_on(spread_vertices(mesh, 5)));
  summary = made.summary();
  return starts;
}

/// Where the iteration is to blame for an estimate that is too large it goes on; H is compressed anew where that is.
TEST(CompressedResponseOf, LooseBodyIsMendedWhereItErrs) {
  ResponseSummary summary;
  EXPECT_EQ(solves(cube(12), 2e-4, summary), 1);
  EXPECT_EQ(summary.compressions, 1);
  EXPECT_EQ(solves(needle_box(60), 3e-3, summary), 2);
  EXPECT_EQ(summary.compressions, 1);
  EXPECT_GE(solves(thin_slab(24, 0.03), 8e-4, summary), 2);
  EXPECT_EQ(summary.compressions, 2);
}

TEST(CompressedResponseOf, NeedleThatIsTooLongNamesItsTip) {
  try {
    model(spiked_sphere(3, 12), 2e-4, Solver::hmatrix);
    FAIL() << "if it can be solved now: use a longer needle";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::numerical);
    EXPECT_THAT(error.what(), testing::HasSubstr("vertex 0 is the tip of a needle"));
    EXPECT_THAT(error.what(), testing::HasSubstr("residual"));
  }
}

TEST(CompressedResponseOf, CurvedDisplacementsMeetTheirToleranceAndTheirEstimate) {
  constexpr double requested = 2e-4;
  for (const TriangleMesh& mesh : {cube(12), slender_ellipsoid(4)}) {
    const std::vector<Landmark> landmarks = landmarks_on(spread_vertices(mesh, 5));
    const auto curved = [&](double tolerance, Solver solver) {
      ResponseModel made(mesh, {.tolerance = tolerance, .solver = solver, .displacements = Displacements::curved});
      made.add(landmarks);
      return made;
    };
    const ResponseModel dense = curved(1e-5, Solver::dense), compressed = curved(requested, Solver::hmatrix);
    const double error = difference(compressed, dense);
    EXPECT_LE(error, tolerance::compressed_response * requested);
    EXPECT_LE(error, tolerance::compressed_estimate * compressed.summary().estimated_error);
    EXPECT_LE(compressed.summary().estimated_error, 1.5 * requested);
    EXPECT_GT(difference(dense, model(mesh, 1e-5, Solver::dense)), 10 * requested);  // another answer
  }
}

/// H in 16 bits, as it is for large skins: their dense matrix would not fit, and a compressed one in double precision
/// takes its place.
TEST(CompressedResponseOf, LargeSkinMeetsItsToleranceAndItsEstimate) {
  const TriangleMesh mesh = slender_ellipsoid(5);
  constexpr double requested = 2e-4;
  ASSERT_TRUE(IterativeOptions::for_tolerance(requested, mesh.vertex_count()).compression.packed);
  const ResponseModel compressed = model(mesh, requested, Solver::hmatrix);
  const double error = difference(compressed, model(mesh, 1e-5, Solver::hmatrix));
  EXPECT_LE(error, tolerance::compressed_response * requested);
  EXPECT_LE(error, tolerance::compressed_estimate * compressed.summary().estimated_error);
  EXPECT_LE(compressed.summary().estimated_error, 3 * requested);
}

TEST(CompressedEdits, GiveWhatAFreshModelGives) {
  const TriangleMesh mesh = slender_ellipsoid(4);
  constexpr double requested = 2e-4;
  const std::vector<std::int32_t> places = spread_vertices(mesh, 6);
  const auto fresh = [&](const std::vector<std::int32_t>& vertices) {
    ResponseModel made(mesh, {.poisson = 0.45, .tolerance = 1e-5, .solver = Solver::dense});
    made.add(landmarks_on(vertices));
    return made;
  };
  ResponseModel edited(mesh, {.poisson = 0.45, .tolerance = requested, .solver = Solver::hmatrix});
  edited.add(landmarks_on({places[0], places[1], places[2]}));
  edited.add(landmarks_on({places[3]}));
  EXPECT_LE(difference(edited, fresh({places[0], places[1], places[2], places[3]})), 2 * requested);
  edited.move(1, landmarks_on({places[4]})[0]);
  EXPECT_LE(difference(edited, fresh({places[0], places[4], places[2], places[3]})), 2 * requested);
  edited.remove(0);
  EXPECT_LE(difference(edited, fresh({places[4], places[2], places[3]})), 2 * requested);
  EXPECT_GT(edited.summary().estimated_error, 0);
}

TEST(CompressedEdits, RefusedOnesChangeNothing) {
  ResponseModel edited = model(slender_ellipsoid(3), 1e-3, Solver::hmatrix);
  const Eigen::MatrixXd before = edited.response();
  const std::vector<Landmark> there = {edited.landmarks().front()};
  EXPECT_THROW(edited.add(there), Error);
  EXPECT_THROW(edited.move(1, there.front()), Error);
  EXPECT_EQ(edited.response(), before);
}

TEST(CompressedEdits, RemovingIsNeverRefused) {
  ResponseModel edited = model(needle_box(120), 1e-3, Solver::hmatrix);
  const int iterations = edited.summary().iterations;
  while (!edited.landmarks().empty()) edited.remove(0);
  EXPECT_EQ(edited.summary().iterations, iterations);
  EXPECT_EQ(edited.summary().estimated_error, 0);
}

TEST(CompressedResponseOf, TwoLandmarksHaveNoEstimateYet) {
  const TriangleMesh mesh = slender_ellipsoid(3);
  ResponseModel made(mesh, {.poisson = 0.45, .tolerance = 1e-3, .solver = Solver::hmatrix});
  const std::vector<std::int32_t> places = spread_vertices(mesh, 4);
  made.add(landmarks_on({places[0], places[1]}));
  EXPECT_EQ(made.summary().estimated_error, 0);
  made.add(landmarks_on({places[2], places[3]}));
  EXPECT_GT(made.summary().estimated_error, 0);
}

}  // namespace
}  // namespace skinbem
