// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/frame/vertex_buffer.hpp>

#include <gtest/gtest.h>

#include "frame/models.hpp"

namespace skinbem {
namespace {

using testing_support::evaluated;
using testing_support::rigid_displacements;
using testing_support::some_motion;
using testing_support::synthetic_skin;
using testing_support::SyntheticSkin;

TEST(VertexTarget, HoldsExactlyWhatFits) {
  std::vector<float> floats(20);
  EXPECT_TRUE((VertexTarget{floats, 0, 3}.holds(6)));
  EXPECT_FALSE((VertexTarget{floats, 0, 3}.holds(7)));
  EXPECT_TRUE((VertexTarget{floats, 1, 8}.holds(3)));
  EXPECT_FALSE((VertexTarget{floats, 2, 8}.holds(3)));
  EXPECT_TRUE((VertexTarget{floats, 20, 3}.holds(0)));
  EXPECT_FALSE((VertexTarget{floats, 21, 3}.holds(0)));
  EXPECT_FALSE((VertexTarget{floats, 18, 3}.holds(1)));
  EXPECT_FALSE((VertexTarget{floats, 0, 2}.holds(1)));
}

TEST(Frame, GoesIntoAnInterleavedBufferAndTouchesNothingElse) {
  for (const Index vertices : {1, 40, 606}) {
    const SyntheticSkin skin = synthetic_skin(vertices, 6);
    const FrameModel model(skin.rest, skin.response, skin.landmarks);
    FrameState state(model);
    ASSERT_TRUE(state.set_landmarks(rigid_displacements(skin.landmarks, some_motion(1))));
    const Points expected = evaluated(state);
    std::vector<float> buffer(static_cast<std::size_t>(8 * vertices), -7.0F);
    ASSERT_TRUE(state.evaluate(VertexTarget{buffer, 4, 8}));
    for (Index i = 0; i < vertices; ++i) {
      for (Index c = 0; c < 8; ++c) {
        const float found = buffer[static_cast<std::size_t>(8 * i + c)];
        EXPECT_EQ(found, c >= 4 && c < 7 ? static_cast<float>(expected(i, c - 4)) : -7.0F);
      }
    }
    EXPECT_FALSE(state.evaluate(VertexTarget{buffer, 6, 8}));
  }
}

TEST(BoundingBox, IsTheTightestAroundTheVertices) {
  const SyntheticSkin skin = synthetic_skin(333, 4);
  const FrameModel model(skin.rest, skin.response, skin.landmarks);
  const FrameState state(model);
  const Points positions = evaluated(state);
  std::vector<float> buffer(5 * 333, 1e9F);
  ASSERT_TRUE(state.evaluate(VertexTarget{buffer, 1, 5}));
  const BoundingBox box = bounding_box({buffer, 1, 5}, 333);
  for (Index c = 0; c < 3; ++c) {
    EXPECT_EQ(box.low[c], static_cast<float>(positions.col(c).minCoeff()));
    EXPECT_EQ(box.high[c], static_cast<float>(positions.col(c).maxCoeff()));
  }
}

}  // namespace
}  // namespace skinbem
