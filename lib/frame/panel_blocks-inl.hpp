// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What panels of every storage share: the shape of the work, and the way of finished sums to memory. Internal to
/// panel_product.cpp.
// Read once for every instruction set, as Highway does it.
#if defined(SKINBEM_FRAME_PANEL_BLOCKS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SKINBEM_FRAME_PANEL_BLOCKS_INL
#undef SKINBEM_FRAME_PANEL_BLOCKS_INL
#else
#define SKINBEM_FRAME_PANEL_BLOCKS_INL
#endif

#include <hwy/cache_control.h>
#include <hwy/highway.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

#include <skinbem/frame/panel_product.hpp>

HWY_BEFORE_NAMESPACE();
namespace skinbem::detail::HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, kHalfPanel>;
using Vector = hn::Vec<Tag>;
constexpr std::size_t kLanes = hn::MaxLanes(Tag());

/// The shape of the work: kVectors vectors of adjacent vertices, kFrames frames at once. There is a sum for each frame,
/// component and vector. kPanels panels, far apart, are evaluated at once: some columns of each, or,
/// kInTurns, one column (or a pair of columns) of each in turns.
///
/// All loops over sums are expanded from index sequences: compilers keep an array in registers only where every index
/// is a constant from the outset.
template <std::size_t kVectors_, std::size_t kFrames_, std::size_t kPanels_ = 1, bool kInTurns_ = false>
struct Block {
  static constexpr std::size_t kVectors = kVectors_;
  static constexpr std::size_t kFrames = kFrames_;
  static constexpr std::size_t kPanels = kPanels_;
  static constexpr bool kInTurns = kInTurns_;
  static constexpr std::size_t kSums = 3 * kVectors * kFrames;
  static constexpr std::size_t kVertices = kVectors * kLanes;

  static constexpr std::size_t frame(std::size_t sum) { return sum / (3 * kVectors); }
  static constexpr std::size_t sum(std::size_t f, std::size_t c, std::size_t v) { return (f * 3 + c) * kVectors + v; }
  /// Where the numbers of a sum are in a column of the panel, relative to the first of the block.
  static constexpr std::size_t place(std::size_t sum) {
    return sum / kVectors % 3 * kPanelWidth + sum % kVectors * kLanes;
  }
  /// Where a sum is in memory: as its numbers are, the next frame kColumnNumbers further.
  static constexpr std::size_t memory(std::size_t sum) { return frame(sum) * kColumnNumbers + place(sum); }
};

/// Which vertex each lane of the three vectors x0 y0 z0 x1 y1 z1 ... takes its coordinates from.
HWY_ALIGN constexpr auto kLaneVertices = [] {
  std::array<std::int32_t, 3 * kLanes> vertices{};
  for (std::size_t i = 0; i < vertices.size(); ++i) vertices[i] = static_cast<std::int32_t>(i / 3);
  return vertices;
}();

/// Q and t of a frame in registers, where there are enough of them.
struct Motion {
  using Lanes = decltype(hn::SetTableIndices(Tag(), kLaneVertices.data()));

  Vector rotation[3][3];
  Vector translation[3];
  Lanes lane_vertices[3];

  explicit HWY_INLINE Motion(const FrameFactors& frame) {
    for (std::size_t m = 0; m < 3; ++m) {
      lane_vertices[m] = hn::SetTableIndices(Tag(), kLaneVertices.data() + m * kLanes);
      translation[m] = hn::Load(Tag(), frame.translation + m * kLanes);
      for (std::size_t j = 0; j < 3; ++j) rotation[j][m] = hn::Load(Tag(), frame.rotation[j] + m * kLanes);
    }
  }

  /// Q (x, y, z) + t as the m-th of the vectors x0 y0 z0 x1 ...: the interleaving is part of the rotation. Each lane
  /// takes the three coordinates of its vertex, times its row of Q.
  HWY_INLINE Vector moved(Vector x, Vector y, Vector z, std::size_t m) const {
    Vector sum = hn::MulAdd(rotation[0][m], hn::TableLookupLanes(x, lane_vertices[m]), translation[m]);
    sum = hn::MulAdd(rotation[1][m], hn::TableLookupLanes(y, lane_vertices[m]), sum);
    return hn::MulAdd(rotation[2][m], hn::TableLookupLanes(z, lane_vertices[m]), sum);
  }
};

/// The same to memory that is not one run of floats, or that ends within the vector.
HWY_NOINLINE void store_apart(const float* packed, const FrameTarget& target, std::size_t vertex,
                              std::size_t vertices) {
  if (vertex >= vertices) return;
  const std::size_t count = std::min(kLanes, vertices - vertex);
  if (target.order == nullptr && target.stride == 3) {
    std::memcpy(target.data + vertex * 3, packed, count * 3 * sizeof(float));
    return;
  }
  for (std::size_t i = 0; i < count; ++i) {
    const std::size_t place = target.order == nullptr ? vertex + i : target.order[vertex + i];
    std::memcpy(target.data + place * target.stride, packed + 3 * i, 3 * sizeof(float));
  }
}

/// The vertices from `vertex` on, to memory with x, y, z adjacent.
HWY_INLINE void move_and_store(Vector x, Vector y, Vector z, const Motion& motion, const FrameTarget& target,
                               std::size_t vertex, std::size_t vertices) {
  const Vector position[] = {motion.moved(x, y, z, 0), motion.moved(x, y, z, 1), motion.moved(x, y, z, 2)};
  if (HWY_LIKELY(target.stride == 3 && target.order == nullptr && vertex + kLanes <= vertices)) {
    float* to = target.data + 3 * vertex;
    for (std::size_t m = 0; m < 3; ++m) hn::StoreU(position[m], Tag(), to + m * kLanes);
    return;
  }
  HWY_ALIGN float packed[3 * kLanes];
  for (std::size_t m = 0; m < 3; ++m) hn::Store(position[m], Tag(), packed + m * kLanes);
  store_apart(packed, target, vertex, vertices);
}

/// The sums of a block, whose first vertex is `vertex`, as positions.
template <class B, class MotionOf, std::size_t... kPosition>
HWY_INLINE void move_and_store_block(const Vector (&sum)[B::kSums], const MotionOf& motion_of,
                                     const FrameTarget* targets, std::size_t vertex, std::size_t vertices,
                                     std::index_sequence<kPosition...>) {
  (move_and_store(sum[B::sum(kPosition / B::kVectors, 0, kPosition % B::kVectors)],
                  sum[B::sum(kPosition / B::kVectors, 1, kPosition % B::kVectors)],
                  sum[B::sum(kPosition / B::kVectors, 2, kPosition % B::kVectors)], motion_of(kPosition / B::kVectors),
                  targets[kPosition / B::kVectors], vertex + kPosition % B::kVectors * kLanes, vertices),
   ...);
}

/// Asks for the numbers of a column, 32 bits each, that a block reads.
template <class B, class Number>
HWY_INLINE void prefetch_block(const Number* from) {
  constexpr std::size_t kLine = 16;
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t i = 0; i < B::kVertices; i += kLine) hwy::Prefetch(from + c * kPanelWidth + i);
  }
}

/// Compilers must have it in one, and treat it as changed.
template <class V>
HWY_INLINE void keep_in_register([[maybe_unused]] V& vector) {
#if HWY_ARCH_X86 && HWY_TARGET != HWY_EMU128 && HWY_TARGET != HWY_SCALAR
  asm volatile("" : "+v"(vector.raw));
#endif
}

/// How many columns (or pairs) before their turn. Asking past the end of a matrix does no harm.
constexpr std::size_t kAhead = 3;

}  // namespace skinbem::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
