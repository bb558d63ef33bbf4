// SPDX-License-Identifier: BSD-3-Clause
// Editing landmarks gives what a fresh solve gives; what is wrong is refused and changes nothing.
#include <gtest/gtest.h>

#include <skinbem/base/error.hpp>
#include <skinbem/response/response_model.hpp>

#include "response/bodies.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using namespace testing_support;

class LandmarkEdits : public ::testing::Test {
 protected:
  TriangleMesh mesh_ = cube(3);
  ResponseModel model_{mesh_, {0.45, 1e-10, {}}};
  std::vector<std::int32_t> places_ = {0, 9, 30, 50};

  void SetUp() override { model_.add(landmarks_on(places_)); }

  Eigen::MatrixXd fresh(const std::vector<Landmark>& landmarks) const {
    ResponseModel model(mesh_, {0.45, 1e-10, {}});
    model.add(landmarks);
    return model.response();
  }
  void expect_as_fresh(const std::vector<Landmark>& landmarks) const {
    EXPECT_LE((model_.response() - fresh(landmarks)).cwiseAbs().maxCoeff(), tolerance::rounding_of_sums);
    ASSERT_EQ(model_.landmarks().size(), landmarks.size());
    for (std::size_t k = 0; k < landmarks.size(); ++k) {
      EXPECT_EQ(model_.landmarks()[k].vertex, landmarks[k].vertex);
      EXPECT_EQ(model_.landmark_positions().row(Index(k)), mesh_.vertices.row(landmarks[k].vertex));
    }
  }
  /// The code and a part of the message of what `action` throws; the response must be what it was.
  template <class Action>
  void expect_refused(ErrorCode code, const std::string& part, const Action& action) {
    const Eigen::MatrixXd before = model_.response();
    try {
      action();
      ADD_FAILURE() << "accepted; expected: " << part;
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), code) << error.what();
      EXPECT_NE(std::string(error.what()).find(part), std::string::npos) << error.what();
    }
    EXPECT_EQ(model_.response(), before);
  }
};

TEST_F(LandmarkEdits, Adding) {
  model_.add(landmarks_on({20}));
  expect_as_fresh(landmarks_on({0, 9, 30, 50, 20}));
}

TEST_F(LandmarkEdits, Moving) {
  model_.move(1, landmarks_on({12})[0]);
  expect_as_fresh(landmarks_on({0, 12, 30, 50}));
}

TEST_F(LandmarkEdits, WithCurvedDisplacements) {
  const auto curved = [&](const std::vector<std::int32_t>& vertices) {
    ResponseModel model(mesh_, {.tolerance = 1e-10, .displacements = Displacements::curved});
    model.add(landmarks_on(vertices));
    return model;
  };
  ResponseModel edited = curved({0, 9, 30});
  edited.add(landmarks_on({50}));
  edited.move(1, landmarks_on({12})[0]);
  const Eigen::MatrixXd expected = curved({0, 12, 30, 50}).response();
  EXPECT_LE((edited.response() - expected).cwiseAbs().maxCoeff(), tolerance::rounding_of_sums);
  model_.move(1, landmarks_on({12})[0]);
  EXPECT_GT((model_.response() - expected).cwiseAbs().maxCoeff(), tolerance::leg_of_2k / 10);  // another answer
}

TEST_F(LandmarkEdits, Removing) {
  model_.remove(1);
  expect_as_fresh(landmarks_on({0, 30, 50}));
}

TEST_F(LandmarkEdits, RemovingAndAddingAgainChangesTheOrderOnly) {
  const Eigen::MatrixXd before = model_.response();
  model_.remove(0);
  model_.add(landmarks_on({0}));
  const Eigen::MatrixXd after = model_.response();
  EXPECT_LE((after.leftCols(9) - before.rightCols(9)).cwiseAbs().maxCoeff(), tolerance::rounding_of_sums);
  EXPECT_LE((after.rightCols(3) - before.leftCols(3)).cwiseAbs().maxCoeff(), tolerance::rounding_of_sums);
}

TEST_F(LandmarkEdits, MovingToItsOwnPlaceIsAllowed) {
  model_.move(2, landmarks_on({30})[0]);
  expect_as_fresh(landmarks_on(places_));
}

TEST_F(LandmarkEdits, PointLandmarksFollowExactly) {
  const Eigen::MatrixXd R = model_.response();
  for (Index k = 0; k < 4; ++k) {
    for (Index l = 0; l < 4; ++l) {
      const Mat3 expected = k == l ? Mat3(Mat3::Identity()) : Mat3(Mat3::Zero());
      EXPECT_LE((R.block<3, 3>(3 * places_[k], 3 * l) - expected).cwiseAbs().maxCoeff(), tolerance::rounding_of_sums);
    }
  }
}

TEST_F(LandmarkEdits, TwoOnOneVertexAreRefusedByName) {
  expect_refused(ErrorCode::bad_input, "L9 and L9 are both on vertex 9", [&] { model_.add(landmarks_on({9})); });
  expect_refused(ErrorCode::bad_input, "both on vertex 21", [&] { model_.add(landmarks_on({21, 22, 21})); });
  expect_refused(ErrorCode::bad_input, "both on vertex 30", [&] { model_.move(0, landmarks_on({30})[0]); });
}

TEST_F(LandmarkEdits, LandmarkOffTheMeshIsRefusedByName) {
  expect_refused(ErrorCode::bad_input, "L56: vertex 56 is not on the mesh", [&] { model_.add(landmarks_on({56})); });
  expect_refused(ErrorCode::bad_input, "L-1: vertex -1 is not", [&] { model_.move(0, landmarks_on({-1})[0]); });
}

TEST_F(LandmarkEdits, RadiusThatIsNoneIsRefused) {
  expect_refused(ErrorCode::usage, "radius", [&] { model_.add(landmarks_on({20}, -1)); });
  expect_refused(ErrorCode::usage, "radius", [&] { model_.add(landmarks_on({20}, std::nan(""))); });
}

TEST_F(LandmarkEdits, NumbersOutOfRangeAreRefused) {
  expect_refused(ErrorCode::usage, "no landmark of that number", [&] { model_.remove(4); });
  expect_refused(ErrorCode::usage, "no landmark of that number", [&] { model_.move(-1, landmarks_on({20})[0]); });
}

ErrorCode code_of_response(const TriangleMesh& mesh, const std::vector<std::int32_t>& places, double radius = 0) {
  ResponseModel model(mesh, {0.45, 1e-6, {}});
  model.add(landmarks_on(places, radius));
  try {
    model.response();
  } catch (const Error& error) {
    return error.code();
  }
  return ErrorCode{};
}

TEST(LandmarkNumber, FewerThanThreeOrAllOnALineAreRefused) {
  const TriangleMesh mesh = cube(2);
  const auto on = [&](const Vec3& x) { return vertex_at(mesh, x); };
  EXPECT_EQ(code_of_response(mesh, {}), ErrorCode::bad_input);
  EXPECT_EQ(code_of_response(mesh, {0, 5}), ErrorCode::bad_input);
  EXPECT_EQ(code_of_response(mesh, {on({0, 0, 0}), on({0.5, 0, 0}), on({1, 0, 0})}), ErrorCode::bad_input);
  EXPECT_EQ(code_of_response(mesh, {on({0, 0, 0}), on({0.5, 0, 0}), on({1, 0, 0}), on({0, 1, 0})}), ErrorCode{});
}

class RefusedOptions : public ::testing::TestWithParam<std::pair<double, double>> {};

TEST_P(RefusedOptions, AreUsageErrors) {
  try {
    const ResponseModel model(tetrahedron(), {GetParam().first, GetParam().second, {}});
    FAIL() << "accepted";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::usage);
  }
}

INSTANTIATE_TEST_SUITE_P(PoissonOrTolerance, RefusedOptions,
                         ::testing::Values(std::pair{-1.0, 1e-6}, std::pair{0.51, 1e-6}, std::pair{std::nan(""), 1e-6},
                                           std::pair{0.3, 1e-13}, std::pair{0.3, 0.5}, std::pair{0.3, 0.0},
                                           std::pair{0.3, std::nan("")}));

TEST(Progress, OfTheResponseCanCancelIt) {
  ResponseOptions options;
  options.progress = [](std::string_view, double) { return false; };
  try {
    const ResponseModel model(cube(3), options);
    FAIL() << "ran to its end";
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::cancelled);
  }
}

}  // namespace
}  // namespace skinbem
