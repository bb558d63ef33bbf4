// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/frame/partial_frame.hpp>

#include <gtest/gtest.h>

#include <limits>

#include <skinbem/base/error.hpp>

#include "frame/models.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using testing_support::rigid_displacements;
using testing_support::some_motion;
using testing_support::synthetic_skin;
using testing_support::SyntheticSkin;

constexpr double kBodySize = 1000;

std::vector<float> positions_of(const auto& frame, Index vertices) {
  std::vector<float> positions(static_cast<std::size_t>(3 * vertices));
  EXPECT_TRUE(frame.evaluate(VertexTarget{positions}));
  return positions;
}

Points as_points(const std::vector<float>& positions) {
  Points result(static_cast<Index>(positions.size() / 3), 3);
  std::copy(positions.begin(), positions.end(), result.data());
  return result;
}

class PartialFrames : public ::testing::TestWithParam<FrameOptions> {
 protected:
  SyntheticSkin skin_ = synthetic_skin(333, 9);
  FrameModel model_{skin_.rest, skin_.response, skin_.landmarks, GetParam()};
  FrameState state_{model_};
  PartialFrame partial_{model_, 3};
  Points pose_ = rigid_displacements(skin_.landmarks, some_motion(0.3)) + 5 * Points::Random(9, 3);

  /// The frame of displacements `u` in the body frame that was held.
  Points expected(const Points& u) const {
    BodyMotion motion = state_.motion();
    for (Index k = 0; k < 9; ++k) {
      motion.weights.segment<3>(3 * k) = body_weight(skin_.landmarks.row(k), u.row(k), motion.rigid, model_.mode());
    }
    FrameState whole(model_);
    EXPECT_TRUE(whole.set_motion(motion));
    return as_points(positions_of(whole, 333));
  }
};

INSTANTIATE_TEST_SUITE_P(ModesAndStorage, PartialFrames,
                         ::testing::Values(FrameOptions(FrameMode::corotated), FrameOptions(FrameMode::linear),
                                           FrameOptions(FrameMode::corotated, FrameStorage::int16),
                                           FrameOptions(FrameMode::linear, FrameStorage::compressed)));

TEST_P(PartialFrames, AreAtRestBeforeAnythingIsHeld) {
  EXPECT_LE((as_points(positions_of(partial_, 333)) - skin_.rest).cwiseAbs().maxCoeff(),
            tolerance::frame_rigid * kBodySize);
}

TEST_P(PartialFrames, AreTheWholeFrameWithTheOthersWhereTheyWere) {
  ASSERT_TRUE(state_.set_landmarks(pose_));
  const std::vector<Index> moving = {7, 2, 4};
  ASSERT_TRUE(partial_.hold(state_, moving));
  EXPECT_LE((as_points(positions_of(partial_, 333)) - expected(pose_)).cwiseAbs().maxCoeff(),
            tolerance::frame_rigid * kBodySize);
  Points u = pose_;
  for (const Index k : moving) u.row(k) += 8 * Eigen::RowVector3d::Random();
  ASSERT_TRUE(partial_.set_landmarks(u(moving, Eigen::all)));
  EXPECT_LE((as_points(positions_of(partial_, 333)) - expected(u)).cwiseAbs().maxCoeff(),
            tolerance::frame_rigid * kBodySize);
}

TEST_P(PartialFrames, DependOnTheirPoseAndNotOnTheFramesBetween) {
  ASSERT_TRUE(state_.set_landmarks(pose_));
  ASSERT_TRUE(partial_.hold(state_, std::vector<Index>{3, 5}));
  const Points u = pose_.middleRows(3, 2);
  ASSERT_TRUE(partial_.set_landmarks(u));
  const std::vector<float> before = positions_of(partial_, 333);
  for (int i = 0; i < 1000; ++i) ASSERT_TRUE(partial_.set_landmarks(u + 20 * Points::Random(2, 3)));
  ASSERT_TRUE(partial_.set_landmarks(u));
  EXPECT_EQ(positions_of(partial_, 333), before);
}

TEST_P(PartialFrames, RefuseWhatIsNoPoseAndKeepTheirs) {
  ASSERT_TRUE(partial_.hold(state_, std::vector<Index>{1, 8}));
  ASSERT_TRUE(partial_.set_landmarks(Points::Ones(2, 3)));
  const std::vector<float> before = positions_of(partial_, 333);
  for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), 1e300}) {
    Points u = Points::Ones(2, 3);
    u(1, 2) = bad;
    EXPECT_FALSE(partial_.set_landmarks(u));
  }
  EXPECT_FALSE(partial_.set_landmarks(Points::Ones(3, 3)));
  const FrameModel other = model_;
  EXPECT_FALSE(partial_.hold(FrameState(other), std::vector<Index>{1}));
  for (const std::vector<Index>& moving : {std::vector<Index>{1, 9}, {-1}, {2, 2}, {0, 1, 2, 3}}) {
    EXPECT_FALSE(partial_.hold(state_, moving));
  }
  std::vector<float> small(998);
  EXPECT_FALSE(partial_.evaluate(VertexTarget{small}));
  EXPECT_EQ(positions_of(partial_, 333), before);
  ASSERT_TRUE(partial_.set_landmarks(Points::Constant(2, 3, 1e33)));
  EXPECT_TRUE(as_points(positions_of(partial_, 333)).allFinite());
}

TEST(PartialFrame, NeedsRoomForOneToAllLandmarks) {
  const SyntheticSkin skin = synthetic_skin(40, 4);
  const FrameModel model(skin.rest, skin.response, skin.landmarks);
  EXPECT_THROW(PartialFrame(model, 0), Error);
  EXPECT_THROW(PartialFrame(model, -3), Error);
  EXPECT_THROW(PartialFrame(model, 5), Error);
}

}  // namespace
}  // namespace skinbem
