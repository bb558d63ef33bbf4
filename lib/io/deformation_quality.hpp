// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// How well a deformed skin keeps what flesh keeps.
#pragma once

#include <vector>

#include <skinbem/io/animation.hpp>

namespace skinbem {

struct FrameQuality {
  double volume_change = 0;  ///< (V - V_rest) / V_rest, signed
  double edge_stretch = 0;   ///< 99th percentile over the edges of |length / length at rest - 1|
  double bones_outside = 0;  ///< share of the bones' vertices outside the skin, 0 without bones
};

/// One entry for every `step`-th frame, from the first. Frames are shared among the threads; the result does not depend
/// on their number.
std::vector<FrameQuality> deformation_quality(const SkinAnimation& skin, const std::vector<MovingBone>& bones = {},
                                              Index step = 1);

/// The worst of each over all frames; of the volume, the change of largest size with its sign.
FrameQuality worst_of(const std::vector<FrameQuality>& frames);

}  // namespace skinbem
