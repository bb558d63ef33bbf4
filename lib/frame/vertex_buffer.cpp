// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/frame/vertex_buffer.hpp>

#include <algorithm>

namespace skinbem {

BoundingBox bounding_box(const VertexSource& positions, std::size_t vertices) noexcept {
  const float* first = positions.vertex(0);
  BoundingBox box{{first[0], first[1], first[2]}, {first[0], first[1], first[2]}};
  for (std::size_t i = 1; i < vertices; ++i) {
    const float* p = positions.vertex(i);
    for (std::size_t c = 0; c < 3; ++c) {
      box.low[c] = std::min(box.low[c], p[c]);
      box.high[c] = std::max(box.high[c], p[c]);
    }
  }
  return box;
}

}  // namespace skinbem
