// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Where a frame is written: any attribute of a caller's interleaved vertex buffer.
#pragma once

#include <cstddef>
#include <span>

namespace skinbem {

/// Three floats for each vertex: those of vertex i are floats[offset + i * stride] and the next two. Nothing between
/// them is touched. Does not own its memory.
template <class Float>
struct VertexAttribute {
  std::span<Float> floats;
  std::size_t offset = 0;
  std::size_t stride = 3;  ///< in floats, 3 or more

  /// Whether `vertices` vertices have their place in it.
  bool holds(std::size_t vertices) const noexcept {
    return stride >= 3 && offset <= floats.size() &&
           (vertices == 0 || (floats.size() - offset >= 3 && (floats.size() - offset - 3) / stride >= vertices - 1));
  }
  Float* vertex(std::size_t i) const noexcept { return floats.data() + offset + i * stride; }
};

using VertexTarget = VertexAttribute<float>;
using VertexSource = VertexAttribute<const float>;

struct BoundingBox {
  float low[3];
  float high[3];
};

/// The smallest box around the first `vertices` positions, 1 or more, in any order of evaluation the same; `positions`
/// must hold them. No allocation.
BoundingBox bounding_box(const VertexSource& positions, std::size_t vertices) noexcept;

}  // namespace skinbem
