// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/frame/frame_model.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

#include <skinbem/base/error.hpp>
#include <skinbem/frame/reading_order.hpp>

#include "frame/models.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using testing_support::evaluated;
using testing_support::rigid_displacements;
using testing_support::some_motion;
using testing_support::synthetic_skin;
using testing_support::SyntheticSkin;

double largest_difference(const Points& a, const Points& b) { return (a - b).cwiseAbs().maxCoeff(); }

/// Random displacements of `size` on top of a rotation of the whole body.
Points bent(const SyntheticSkin& skin, double angle, double size) {
  return rigid_displacements(skin.landmarks, some_motion(angle)) + size * Points::Random(skin.landmarks.rows(), 3);
}

TEST(Frame, RigidMotionOfTheLandmarksMovesTheSkinRigidly) {
  const SyntheticSkin skin = synthetic_skin(606, 6);
  const FrameModel model(skin.rest, skin.response, skin.landmarks);
  FrameState state(model);
  for (const double angle : {0.0, 0.1, 1.0, 2.5, M_PI}) {
    const RigidMotion motion = some_motion(angle);
    ASSERT_TRUE(state.set_landmarks(rigid_displacements(skin.landmarks, motion)));
    const Points expected = skin.rest + rigid_displacements(skin.rest, motion);
    const double size = expected.cwiseAbs().maxCoeff();
    EXPECT_LE(largest_difference(evaluated(state), expected), tolerance::frame_rigid * size);
    const Points reference = evaluate_reference(skin.rest, skin.response, state.motion());
    EXPECT_LE(largest_difference(reference, expected), tolerance::frame_reference * size);
  }
}

TEST(Frame, AgreesWithTheReferenceForAnySizeAndMode) {
  FrameOptions fine(FrameMode::corotated, FrameStorage::int16);
  fine.error_bound = 1e-6;
  for (const FrameOptions& options : {FrameOptions(FrameMode::corotated), FrameOptions(FrameMode::linear), fine}) {
    for (const Index vertices : {1, 7, 16, 17, 31, 32, 33, 64, 606, 1000}) {
      const SyntheticSkin skin = synthetic_skin(vertices, 1 + vertices % 9);
      const FrameModel model(skin.rest, skin.response, skin.landmarks, options);
      FrameState state(model);
      EXPECT_LE(largest_difference(evaluated(state), skin.rest), tolerance::frame_rigid * 1000);
      ASSERT_TRUE(state.set_landmarks(bent(skin, 0.4, 10)));
      const Points reference = evaluate_reference(skin.rest, skin.response, state.motion());
      EXPECT_LE(largest_difference(evaluated(state), reference), tolerance::frame_rigid * 1000) << vertices;
    }
  }
}

TEST(Frame, LinearModeIsRestPlusResponseTimesDisplacement) {
  const SyntheticSkin skin = synthetic_skin(50, 4);
  const FrameModel model(skin.rest, skin.response, skin.landmarks, FrameMode::linear);
  FrameState state(model);
  const Points displacement = bent(skin, 0.5, 5);
  ASSERT_TRUE(state.set_landmarks(displacement));
  const Eigen::VectorXd moved = skin.response * Eigen::Map<const Eigen::VectorXd>(displacement.data(), 12);
  EXPECT_LE(largest_difference(evaluated(state), skin.rest + Eigen::Map<const Points>(moved.data(), 50, 3)),
            tolerance::frame_rigid * 1000);
}

TEST(Frame, CorotatedSkinTurnsWithTheBodyThatIsDeformedAlike) {
  const SyntheticSkin skin = synthetic_skin(100, 6);
  const FrameModel model(skin.rest, skin.response, skin.landmarks);
  FrameState state(model);
  const Points displacement = bent(skin, 0, 8);
  ASSERT_TRUE(state.set_landmarks(displacement));
  const Points before = evaluated(state);
  const RigidMotion turn = some_motion(2);
  ASSERT_TRUE(state.set_landmarks(displacement + rigid_displacements(skin.landmarks + displacement, turn)));
  const Points expected = before + rigid_displacements(before, turn);
  EXPECT_LE(largest_difference(evaluated(state), expected), 4 * tolerance::frame_rigid * 1000);
}

class Batch : public testing::TestWithParam<FrameStorage> {};
INSTANTIATE_TEST_SUITE_P(Storage, Batch,
                         testing::Values(FrameStorage::float32, FrameStorage::int16, FrameStorage::compressed));

TEST_P(Batch, GivesTheSameBitsAsFramesOneByOne) {
  const SyntheticSkin skin = synthetic_skin(333, 6);
  const FrameModel model(skin.rest, skin.response, skin.landmarks, {FrameMode::corotated, GetParam()});
  for (const std::size_t count :
       {std::size_t{1}, std::size_t{2}, std::size_t{3}, std::size_t{5}, std::size_t{9}, std::size_t{70}}) {
    std::vector<FrameState> states(count, FrameState(model));
    for (std::size_t f = 0; f < count; ++f)
      ASSERT_TRUE(states[f].set_landmarks(bent(skin, 0.2 + 0.01 * double(f), 10)));
    std::vector<float> batch(count * 999);
    ASSERT_TRUE(evaluate_batch(states, batch));
    std::vector<float> single(999);
    for (std::size_t f = 0; f < count; ++f) {
      ASSERT_TRUE(states[f].evaluate(single));
      EXPECT_TRUE(std::equal(single.begin(), single.end(), batch.begin() + std::ptrdiff_t(999 * f))) << f;
    }
  }
}

/// So large that the order in which frames read it is timed; a batch reads one panel after the other in any case.
TEST(Frame, OfAModelBeyondTheCachesHasTheSameBitsInEitherOrder) {
  const SyntheticSkin skin = synthetic_skin(5001, 100);
  const FrameModel model(skin.rest, skin.response, skin.landmarks);
  ASSERT_GE(model.bytes(), detail::kLeastBytesInTurns);
  const std::vector<FrameState> states(2, [&] {
    FrameState state(model);
    EXPECT_TRUE(state.set_landmarks(bent(skin, 0.2, 10)));
    return state;
  }());
  std::vector<float> single(3 * 5001), batch(2 * single.size());
  ASSERT_TRUE(states[0].evaluate(single));
  ASSERT_TRUE(evaluate_batch(states, batch));
  EXPECT_TRUE(std::equal(single.begin(), single.end(), batch.begin()));
}

TEST(ReadingOrder, IsNotTimedForModelsInCaches) {
  const detail::PanelMatrix not_to_be_read{nullptr, nullptr, 1000};
  EXPECT_FALSE(detail::faster_in_turns(not_to_be_read, detail::kLeastBytesInTurns - 1, 18));
}

class ErrorBound : public testing::TestWithParam<FrameStorage> {};
INSTANTIATE_TEST_SUITE_P(Storage, ErrorBound, testing::Values(FrameStorage::int16, FrameStorage::compressed));

TEST_P(ErrorBound, HoldsForAnyMotionInRange) {
  for (const Index landmarks : {3, 6, 40}) {
    const SyntheticSkin skin = synthetic_skin(700, landmarks);
    const Points centred = skin.rest.rowwise() - skin.rest.colwise().mean();
    for (const double bound : {1e-2, 1e-3, 2e-5}) {
      FrameOptions options(FrameMode::linear, GetParam());
      options.error_bound = bound;
      // About the origin, so that the rounding of the sum itself is small.
      const FrameModel model(centred, skin.response, skin.landmarks, options);
      EXPECT_LE(model.achieved_error_bound(), bound);
      FrameState state(model);
      double worst = 0;
      for (int i = 0; i < 20; ++i) {
        const Points direction = Points::Random(landmarks, 3);
        const Points displacement = options.motion_range * direction.rowwise().normalized();
        ASSERT_TRUE(state.set_landmarks(displacement));
        const Points error = evaluated(state) - evaluate_reference(centred, skin.response, state.motion());
        worst = std::max(worst, error.rowwise().norm().maxCoeff());
      }
      EXPECT_LE(worst, model.achieved_error_bound() + 2 * tolerance::frame_rigid * 200);
      EXPECT_GE(worst, 0.02 * model.achieved_error_bound()) << "a bound that no motion comes near says nothing";
    }
  }
}

/// Vertices in no order, each moved smoothly by many landmarks: a patch follows few directions.
TEST(Frame, CompressedTakesAThirdOfTheBytesOfASmoothSkin) {
  SyntheticSkin skin = synthetic_skin(4000, 40);
  for (Index i = 0; i < 4000; ++i) {
    for (Index k = 0; k < 40; ++k) {
      const double distance = (skin.rest.row(i) - skin.landmarks.row(k)).norm();
      skin.response.block<3, 3>(3 * i, 3 * k) = std::exp(-distance * distance / 40000) / 40 * Mat3::Identity();
    }
  }
  const FrameModel whole(skin.rest, skin.response, skin.landmarks);
  const FrameModel third(skin.rest, skin.response, skin.landmarks, {FrameMode::corotated, FrameStorage::compressed});
  EXPECT_LE(third.achieved_error_bound(), 1e-3);
  EXPECT_GT(third.achieved_error_bound(), 0);
  EXPECT_LE(static_cast<double>(third.bytes()), static_cast<double>(whole.bytes()) / 3);
}

TEST(Frame, Int16TakesHalfTheBytes) {
  const SyntheticSkin skin = synthetic_skin(640, 20);
  const FrameModel whole(skin.rest, skin.response, skin.landmarks);
  FrameOptions options(FrameMode::corotated, FrameStorage::int16);
  options.error_bound = 1e-2;  // these vertices are in random order: a panel is no patch, and its scales are large
  const FrameModel half(skin.rest, skin.response, skin.landmarks, options);
  EXPECT_EQ(whole.achieved_error_bound(), 0);
  EXPECT_LE(static_cast<double>(half.bytes()), 0.55 * static_cast<double>(whole.bytes()));
}

TEST(Frame, RefusesLandmarksThatAreNotFiniteAndKeepsThePose) {
  const SyntheticSkin skin = synthetic_skin(64, 4);
  for (const FrameMode mode : {FrameMode::corotated, FrameMode::linear}) {
    const FrameModel model(skin.rest, skin.response, skin.landmarks, mode);
    FrameState state(model);
    ASSERT_TRUE(state.set_landmarks(bent(skin, 0.1, 3)));
    const Points before = evaluated(state);
    for (const double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity(), -1e300,
                             double{std::numeric_limits<float>::max()}}) {
      Points displacement = bent(skin, 0.1, 3);
      displacement(2, 1) = bad;
      EXPECT_FALSE(state.set_landmarks(displacement)) << bad;
      EXPECT_EQ(evaluated(state), before);
    }
    EXPECT_FALSE(state.set_landmarks(Points::Zero(3, 3)));
    Points huge = Points::Constant(4, 3, 1e33);
    huge(0, 0) = -1e33;
    ASSERT_TRUE(state.set_landmarks(huge));
    EXPECT_TRUE(evaluated(state).allFinite());
  }
}

TEST(Frame, WritesNothingIntoABufferOfAnotherSize) {
  const SyntheticSkin skin = synthetic_skin(40, 3);
  const FrameModel model(skin.rest, skin.response, skin.landmarks);
  const std::vector<FrameState> states(2, FrameState(model));
  for (const std::size_t size : {std::size_t{0}, std::size_t{119}, std::size_t{121}}) {
    std::vector<float> positions(size, -1.0F);
    EXPECT_FALSE(states[0].evaluate(positions));
    EXPECT_FALSE(evaluate_batch(states, positions));
    EXPECT_THAT(positions, testing::Each(-1.0F));
  }
  EXPECT_TRUE(evaluate_batch({}, {}));
}

TEST(FrameModel, WarnsOfLandmarksOnALine) {
  SyntheticSkin skin = synthetic_skin(40, 3);
  EXPECT_TRUE(FrameModel(skin.rest, skin.response, skin.landmarks).warnings().empty());
  for (Index k = 0; k < 3; ++k) skin.landmarks.row(k) << 0, 0.001 * double(k * k), 100.0 * double(k);
  EXPECT_THAT(FrameModel(skin.rest, skin.response, skin.landmarks).warnings(),
              testing::ElementsAre(testing::HasSubstr("nearly collinear")));
  EXPECT_TRUE(FrameModel(skin.rest, skin.response, skin.landmarks, FrameMode::linear).warnings().empty());
}

TEST(FrameModel, RefusesLengthsThatAreNotPositive) {
  const SyntheticSkin skin = synthetic_skin(40, 3);
  for (const double length : {0.0, -1.0, std::numeric_limits<double>::quiet_NaN()}) {
    FrameOptions options;
    options.error_bound = length;
    EXPECT_THROW(FrameModel(skin.rest, skin.response, skin.landmarks, options), Error);
    options = {};
    options.motion_range = length;
    EXPECT_THROW(FrameModel(skin.rest, skin.response, skin.landmarks, options), Error);
  }
}

TEST(FrameModel, RefusesWhatIsNoModel) {
  const SyntheticSkin skin = synthetic_skin(40, 3);
  const auto refused = [&](const SyntheticSkin& bad, ErrorCode code) {
    try {
      const FrameModel model(bad.rest, bad.response, bad.landmarks);
    } catch (const Error& error) {
      return error.code() == code;
    }
    return false;
  };
  SyntheticSkin bad = skin;
  bad.response.conservativeResize(120, 8);
  EXPECT_TRUE(refused(bad, ErrorCode::usage));
  bad = skin;
  bad.rest.conservativeResize(39, 3);
  EXPECT_TRUE(refused(bad, ErrorCode::usage));
  EXPECT_TRUE(refused({}, ErrorCode::usage));
  for (const double number : {std::numeric_limits<double>::quiet_NaN(), 1e39}) {
    bad = skin;
    bad.response(7, 5) = number;
    EXPECT_TRUE(refused(bad, ErrorCode::bad_input));
    bad = skin;
    bad.rest(3, 1) = number;
    EXPECT_TRUE(refused(bad, ErrorCode::bad_input));
    bad = skin;
    bad.landmarks(0, 2) = number;
    EXPECT_TRUE(refused(bad, ErrorCode::bad_input));
  }
}

}  // namespace
}  // namespace skinbem
