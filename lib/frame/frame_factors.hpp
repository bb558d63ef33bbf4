// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Weights and the rigid part of a frame as the kernel wants them. Internal to the floor.
#pragma once

#include <algorithm>
#include <cmath>
#include <limits>

#include <skinbem/base/aligned_buffer.hpp>
#include <skinbem/base/types.hpp>
#include <skinbem/frame/panel_product.hpp>

namespace skinbem::detail {

/// Numbers beyond this never enter a frame; the margin to the largest float holds the rotation and translation.
inline constexpr double kLargestNumber = 1e-2 * std::numeric_limits<float>::max();

/// Entries of a rotation, rounded.
inline constexpr double kLargestOfRotation = 1.001;

/// Memory for `count` weights, zeros, with what the kernel reads behind them.
inline AlignedVector<float> make_weights(std::size_t count) {
  return AlignedVector<float>(count + kHalfPanel - 1, 0.0F);
}

/// The least power of two above `count` weights.
inline float weight_limit(const float* weights, std::size_t count) noexcept {
  constexpr float least = 0x1p-100F;  // its inverse is finite, too
  float largest = least;
  for (std::size_t k = 0; k < count; ++k) largest = std::max(largest, std::abs(weights[k]));
  return std::ldexp(1.0F, std::ilogb(largest) + 1);
}

/// Q and t for every lane, of rest positions that were packed relative to `centre`. The weights stay as they are.
inline void repeat_rigid(const RigidMotion& rigid, const Vec3& centre, FrameFactors& factors) noexcept {
  const Eigen::Matrix3f rotation = rigid.rotation.cast<float>();
  const Eigen::Vector3f translation = rigid(centre).cast<float>();
  for (Index i = 0; i < Index{FrameFactors::kRepeated}; i += 3) {
    for (Index j = 0; j < 3; ++j) Eigen::Map<Eigen::Vector3f>(factors.rotation[j] + i) = rotation.col(j);
    Eigen::Map<Eigen::Vector3f>(factors.translation + i) = translation;
  }
}

}  // namespace skinbem::detail
