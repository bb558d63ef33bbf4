// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// One of everything that runs per frame, for the tests of what a frame must not do.
#pragma once

#include <skinbem/frame/handles.hpp>
#include <skinbem/frame/normals.hpp>
#include <skinbem/frame/partial_frame.hpp>

#include "frame/models.hpp"
#include "meshes.hpp"

namespace skinbem::testing_support {

class EveryFrame {
 public:
  /// All kinds of frames once; false where one of them refused.
  bool run() noexcept {
    ++turn_;
    bool good = true;
    for (FrameState* state : {&whole_, &half_, &patches_}) {
      good = good && state->set_landmarks(displacement_) && state->evaluate(VertexTarget{buffer_, 3, 8});
      good = good && state->evaluate(VertexTarget{positions_}, threads_);
    }
    good = good && evaluate_batch(states_, batch_);
    good = good && partial_.hold(whole_, moving_) && partial_.set_landmarks(displacement_.topRows(2));
    good = good && partial_.evaluate(VertexTarget{positions_});
    const VertexSource source{positions_};
    good = good && normals_.evaluate(source, VertexTarget{buffer_, 0, 8});
    good = good && bounding_box(source, 1000).low[0] < 1e9F;
    good = good && handles_.grab(70 + turn_ % 50) && handles_.pull(pulls_) && handles_.move(4, 120 + turn_ % 40);
    good = good && handles_.evaluate(VertexTarget{ellipsoid_}) && handles_.release(4);
    return good && handles_.pull(0, Vec3(0, 0, 1)) && handles_.evaluate(VertexTarget{ellipsoid_}, threads_);
  }

 private:
  SyntheticSkin skin_ = synthetic_skin(1000, 6);
  FrameModel float32_{skin_.rest, skin_.response, skin_.landmarks};
  FrameModel int16_{skin_.rest, skin_.response, skin_.landmarks, {FrameMode::corotated, FrameStorage::int16}};
  FrameModel compressed_{skin_.rest, skin_.response, skin_.landmarks, {FrameMode::corotated, FrameStorage::compressed}};
  FrameState patches_{compressed_};
  FrameState whole_{float32_};
  FrameState half_{int16_};
  PartialFrame partial_{float32_, 2};
  std::vector<Index> moving_ = {4, 1};
  std::vector<FrameState> states_ = std::vector<FrameState>(5, FrameState(float32_));
  Points displacement_ = Points::Random(6, 3);
  std::vector<float> positions_ = std::vector<float>(3000);
  std::vector<float> batch_ = std::vector<float>(15000);
  std::vector<float> buffer_ = std::vector<float>(8000);
  FrameThreads threads_{2, 0};
  VertexNormals normals_{Triangles{{0, 1, 2}, {2, 1, 3}}, 1000};

  TriangleMesh mesh_ = slender_ellipsoid(2);
  ResponseModel body_{mesh_};
  HandleModel handle_model_{body_, 1};
  Handles handles_{handle_model_, std::vector<std::int32_t>{0, 9, 30, 50}, 40};
  std::vector<float> ellipsoid_ = std::vector<float>(static_cast<std::size_t>(3 * mesh_.vertex_count()));
  Points pulls_ = Points::Random(5, 3);
  std::int32_t turn_ = 0;
};

}  // namespace skinbem::testing_support
