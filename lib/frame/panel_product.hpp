// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The kernel of a frame: y = Q (X + R q) + t over panels of vertices, SIMD with run-time dispatch. Internal to the
/// floor; FrameModel and FrameState are what a user sees.
#pragma once

#include <cstddef>

namespace skinbem::detail {

/// Vertices a panel: whole vectors of every instruction set up to 512 bit, and little padding on small skins.
inline constexpr std::size_t kPanelWidth = 32;
/// Floats of one column of a panel: x of 32 vertices, then y, then z.
inline constexpr std::size_t kColumnFloats = 3 * kPanelWidth;

/// [X R] in single precision. Panel p holds the vertices 32 p ... 32 p + 31, column 0 their rest positions, column
/// 1 + k column k of R; padding vertices are zero. A frame so reads one sequential stream. 64-byte aligned.
struct PanelMatrix {
  const float* data = nullptr;
  std::size_t vertices = 0;
  std::size_t columns = 0;  ///< of R

  std::size_t panels() const { return (vertices + kPanelWidth - 1) / kPanelWidth; }
  std::size_t panel_floats() const { return (columns + 1) * kColumnFloats; }
};

/// What changes from frame to frame.
struct FrameFactors {
  const float* weights = nullptr;                   ///< q, one a column
  float rotation[9] = {1, 0, 0, 0, 1, 0, 0, 0, 1};  ///< Q, row-major
  float translation[3] = {0, 0, 0};                 ///< t
};

/// Where a frame goes: position i is written to data[i * stride + 0, 1, 2].
struct FrameTarget {
  float* data = nullptr;
  std::size_t stride = 3;
};

/// Evaluates `frame_count` frames on the panels [first, last). Each number is summed in the order of the columns
/// whatever the range and the number of frames, so results are the same bits for any division of the work.
void panel_product(const PanelMatrix& matrix, std::size_t first, std::size_t last, const FrameFactors* frames,
                   const FrameTarget* targets, std::size_t frame_count) noexcept;

/// Name of the instruction set that panel_product uses on this machine.
const char* instruction_set() noexcept;

}  // namespace skinbem::detail
