// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/frame/frame_threads.hpp>

#include <gtest/gtest.h>

#include <thread>

#include <skinbem/base/error.hpp>

#include "frame/models.hpp"

namespace skinbem {
namespace {

using testing_support::rigid_displacements;
using testing_support::some_motion;
using testing_support::synthetic_skin;
using testing_support::SyntheticSkin;

Points pose(const SyntheticSkin& skin, double angle) { return rigid_displacements(skin.landmarks, some_motion(angle)); }

TEST(FrameThreads, GiveTheSameBitsHoweverMany) {
  for (const FrameStorage storage : {FrameStorage::float32, FrameStorage::int16, FrameStorage::compressed}) {
    const SyntheticSkin skin = synthetic_skin(5000, 6);
    const FrameModel model(skin.rest, skin.response, skin.landmarks, {FrameMode::linear, storage});
    FrameState state(model);
    std::vector<float> expected(15000);
    std::vector<float> found(15000);
    for (const int count : {1, 2, 3}) {
      FrameThreads threads(count, 0);
      EXPECT_EQ(threads.count(), count);
      for (int i = 0; i < 300; ++i) {
        ASSERT_TRUE(state.set_landmarks(pose(skin, 0.01 * i)));
        ASSERT_TRUE(state.evaluate(expected));
        ASSERT_TRUE(state.evaluate(VertexTarget{found}, threads));
        ASSERT_EQ(found, expected) << count << " threads, frame " << i;
      }
    }
  }
}

TEST(FrameThreads, ServeSkinsInTurns) {
  const SyntheticSkin one = synthetic_skin(5000, 6), other = synthetic_skin(7000, 4);
  const FrameModel models[] = {{one.rest, one.response, one.landmarks}, {other.rest, other.response, other.landmarks}};
  FrameState states[] = {FrameState(models[0]), FrameState(models[1])};
  ASSERT_TRUE(states[0].set_landmarks(pose(one, 0.3)));
  ASSERT_TRUE(states[1].set_landmarks(pose(other, 0.3)));
  FrameThreads threads(2, 0);
  for (int i = 0; i < 1200; ++i) {  // some alone for comparison, the others not
    const FrameState& state = states[i % 2];
    std::vector<float> expected(static_cast<std::size_t>(3 * state.model().vertex_count())), found = expected;
    ASSERT_TRUE(state.evaluate(expected));
    ASSERT_TRUE(state.evaluate(VertexTarget{found}, threads));
    ASSERT_EQ(found, expected) << "frame " << i;
  }
}

TEST(FrameThreads, ServeCallersOnSeveralThreads) {
  const SyntheticSkin skin = synthetic_skin(3000, 6);
  const FrameModel model(skin.rest, skin.response, skin.landmarks);
  FrameThreads threads(2, 0);
  std::vector<char> good(3, 0);
  std::vector<std::thread> callers;
  for (std::size_t c = 0; c < good.size(); ++c) {
    callers.emplace_back([&, c] {
      FrameState state(model);
      std::vector<float> expected(9000);
      std::vector<float> found(9000);
      bool all = true;
      for (int i = 0; i < 200; ++i) {
        all = all && state.set_landmarks(pose(skin, 0.1 * static_cast<double>(c) + 0.01 * i)) &&
              state.evaluate(expected) && state.evaluate(VertexTarget{found}, threads) && found == expected;
      }
      good[c] = all;
    });
  }
  for (std::thread& caller : callers) caller.join();
  EXPECT_EQ(good, std::vector<char>(3, 1));
}

TEST(FrameThreads, LeaveSmallModelsAndWrongBuffersAlone) {
  const SyntheticSkin skin = synthetic_skin(100, 3);
  const FrameModel model(skin.rest, skin.response, skin.landmarks);
  const FrameState state(model);
  FrameThreads threads(2);
  std::vector<float> positions(300);
  EXPECT_TRUE(state.evaluate(VertexTarget{positions}, threads));
  positions.resize(299);
  EXPECT_FALSE(state.evaluate(VertexTarget{positions}, threads));
  EXPECT_THROW(FrameThreads(-1), Error);
  EXPECT_GE(FrameThreads().count(), 1);
}

TEST(FrameThreads, MeasureFromWhichSizeTheyHelpUnlessTold) {
  EXPECT_EQ(FrameThreads(2, 12345).least_bytes(), 12345);
  const std::size_t measured = FrameThreads(2).least_bytes();
  EXPECT_GE(measured, 64 * 1024);
  const std::size_t never = FrameThreads(1).least_bytes();
  EXPECT_TRUE(measured <= 4 * 1024 * 1024 || measured == never);
  EXPECT_GT(never, std::size_t{1} << 60);
}

}  // namespace
}  // namespace skinbem
