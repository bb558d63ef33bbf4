// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/frame/panel_product.hpp>

#include <algorithm>
#include <array>
#include <cstring>
#include <utility>

// Vectors of a length unknown at compile time cannot be array elements; such machines use their fixed-length set.
#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_RVV | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#endif
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "skinbem/frame/panel_product.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h comes first
#include <hwy/cache_control.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace skinbem::detail {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

using Tag = hn::CappedTag<float, kHalfPanel>;
using Vector = hn::Vec<Tag>;
constexpr std::size_t kLanes = hn::MaxLanes(Tag());

/// The shape of the work: kVectors vectors of vertices, the first half of them in the first half of the panel, the
/// others 16 vertices on; kFrames frames at once. There is a sum for each frame, component and vector.
///
/// All loops over sums are expanded from index sequences: compilers keep an array in registers only where every index
/// is a constant from the outset.
template <std::size_t kVectors_, std::size_t kFrames_>
struct Block {
  static constexpr std::size_t kVectors = kVectors_;
  static constexpr std::size_t kFrames = kFrames_;
  static constexpr std::size_t kSums = 3 * kVectors * kFrames;
  static constexpr std::size_t kVertices = kVectors / 2 * kLanes;  // in each half of the panel

  static constexpr std::size_t frame(std::size_t sum) { return sum / (3 * kVectors); }
  static constexpr std::size_t component(std::size_t sum) { return sum / kVectors % 3; }
  static constexpr std::size_t vector(std::size_t sum) { return sum % kVectors; }
  static constexpr std::size_t sum(std::size_t f, std::size_t c, std::size_t v) { return (f * 3 + c) * kVectors + v; }
  /// First vertex of a vector, relative to that of the block.
  static constexpr std::size_t begin(std::size_t v) {
    return v < kVectors / 2 ? v * kLanes : kHalfPanel + (v - kVectors / 2) * kLanes;
  }
};

/// Numbers of a float column, or rest positions, for sum i.
template <class B>
HWY_INLINE Vector numbers(const float* HWY_RESTRICT column, std::size_t i) {
  return hn::Load(Tag(), column + B::component(i) * kPanelWidth + B::begin(B::vector(i)));
}

/// Numbers of a quantised column, times 2^16: a word is the number of its upper half as it is, that of its lower half
/// after a shift.
template <class B>
HWY_INLINE Vector numbers(const std::int32_t* HWY_RESTRICT column, std::size_t i) {
  const std::size_t v = B::vector(i);
  const std::size_t place = v % (B::kVectors / 2) * kLanes;
  const auto word = hn::Load(hn::RebindToSigned<Tag>(), column + B::component(i) * kHalfPanel + place);
  return hn::ConvertTo(Tag(), v < B::kVectors / 2 ? hn::ShiftLeft<16>(word) : word);
}

/// What a panel's columns are: floats in order, or words with a list of which and how large.
struct FloatColumns {
  static constexpr std::size_t kStep = kColumnNumbers;
  const float* column;

  FloatColumns(const std::byte* panel, std::size_t) : column(reinterpret_cast<const float*>(panel + kRestBytes)) {}
  float weight(const FrameFactors& frame, std::size_t entry) const { return frame.weights[entry]; }
};

struct QuantisedColumns {
  static constexpr std::size_t kStep = kColumnNumbers / 2;
  const std::uint32_t* which;
  const float* scale;
  const std::int32_t* column;

  QuantisedColumns(const std::byte* panel, std::size_t entries)
      : which(reinterpret_cast<const std::uint32_t*>(panel + kRestBytes)),
        scale(reinterpret_cast<const float*>(which + entries)),
        column(reinterpret_cast<const std::int32_t*>(panel + kRestBytes + entry_list_bytes(entries))) {
    // read beside the columns later on, the list would interrupt their stream, line by line
    for (std::size_t line = 0; line < entry_list_bytes(entries); line += 64) hwy::Prefetch(panel + kRestBytes + line);
  }
  float weight(const FrameFactors& frame, std::size_t entry) const {
    return scale[entry] * frame.weights[which[entry]];
  }
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

/// The part of a panel that begins `shift` vertices into it.
template <class B, class Columns, class MotionOf, std::size_t... kSum, std::size_t... kFrame, std::size_t... kPosition>
HWY_INLINE void evaluate_block(const PanelMatrix& matrix, std::size_t panel, std::size_t shift,
                               const FrameFactors* frames, const MotionOf& motion_of, const FrameTarget* targets,
                               std::index_sequence<kSum...>, std::index_sequence<kFrame...>,
                               std::index_sequence<kPosition...>) {
  const std::byte* data = matrix.data + matrix.places[panel].offset;
  const std::size_t entries = matrix.places[panel].entries;
  const Columns columns(data, entries);
  const auto* column = columns.column + shift;
  Vector sum[] = {hn::Mul(hn::Set(Tag(), frames[B::frame(kSum)].rest),
                          numbers<B>(reinterpret_cast<const float*>(data) + shift, kSum))...};
  for (std::size_t k = 0; k < entries; ++k, column += Columns::kStep) {
    const Vector weight[] = {hn::Set(Tag(), columns.weight(frames[kFrame], k))...};
    ((sum[kSum] = hn::MulAdd(numbers<B>(column, kSum), weight[B::frame(kSum)], sum[kSum])), ...);
  }
  const std::size_t first = panel * kPanelWidth + shift;
  (move_and_store(sum[B::sum(kPosition / B::kVectors, 0, kPosition % B::kVectors)],
                  sum[B::sum(kPosition / B::kVectors, 1, kPosition % B::kVectors)],
                  sum[B::sum(kPosition / B::kVectors, 2, kPosition % B::kVectors)], motion_of(kPosition / B::kVectors),
                  targets[kPosition / B::kVectors], first + B::begin(kPosition % B::kVectors), matrix.vertices),
   ...);
}

template <class B, class Columns, class MotionOf>
HWY_INLINE void evaluate_panel(const PanelMatrix& matrix, std::size_t panel, const FrameFactors* frames,
                               const MotionOf& motion_of, const FrameTarget* targets) {
  for (std::size_t shift = 0; shift < kHalfPanel; shift += B::kVertices) {
    evaluate_block<B, Columns>(matrix, panel, shift, frames, motion_of, targets, std::make_index_sequence<B::kSums>(),
                               std::make_index_sequence<B::kFrames>(),
                               std::make_index_sequence<B::kFrames * B::kVectors>());
  }
}

// As many sums as registers allow: enough to hide the latency of the multiply-add, and in a batch each number of R that
// is loaded serves several frames.
using SingleBlock = Block<std::min<std::size_t>(4, kPanelWidth / kLanes), 1>;
using BatchBlock = Block<2, (kLanes >= 16 ? 4 : 2)>;

/// One frame: its motion stays in registers from panel to panel.
template <class Columns>
HWY_INLINE void evaluate_single(const PanelMatrix& matrix, std::size_t first, std::size_t last,
                                const FrameFactors& frame, const FrameTarget& target) {
  const Motion motion(frame);
  const auto motion_of = [&](std::size_t) -> const Motion& { return motion; };
  for (std::size_t panel = first; panel < last; ++panel) {
    evaluate_panel<SingleBlock, Columns>(matrix, panel, &frame, motion_of, &target);
  }
}

template <class Columns>
HWY_INLINE void evaluate_panels(const PanelMatrix& matrix, std::size_t first, std::size_t last,
                                const FrameFactors* frames, const FrameTarget* targets, std::size_t frame_count) {
  if (frame_count == 1) {
    evaluate_single<Columns>(matrix, first, last, *frames, *targets);
    return;
  }
  for (std::size_t panel = first; panel < last; ++panel) {
    std::size_t f = 0;
    const auto motion_of = [&](std::size_t i) { return Motion(frames[f + i]); };
    for (; f + BatchBlock::kFrames <= frame_count; f += BatchBlock::kFrames) {
      evaluate_panel<BatchBlock, Columns>(matrix, panel, frames + f, motion_of, targets + f);
    }
    for (; f < frame_count; ++f)
      evaluate_panel<SingleBlock, Columns>(matrix, panel, frames + f, motion_of, targets + f);
  }
}

void panel_product(const PanelMatrix& matrix, std::size_t first, std::size_t last, const FrameFactors* frames,
                   const FrameTarget* targets, std::size_t frame_count) {
  if (matrix.quantised) {
    evaluate_panels<QuantisedColumns>(matrix, first, last, frames, targets, frame_count);
  } else {
    evaluate_panels<FloatColumns>(matrix, first, last, frames, targets, frame_count);
  }
}

const char* instruction_set() { return hwy::TargetName(HWY_TARGET); }

}  // namespace HWY_NAMESPACE
}  // namespace skinbem::detail
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skinbem::detail {

HWY_EXPORT(panel_product);
HWY_EXPORT(instruction_set);

void panel_product(const PanelMatrix& matrix, std::size_t first, std::size_t last, const FrameFactors* frames,
                   const FrameTarget* targets, std::size_t frame_count) noexcept {
  HWY_DYNAMIC_DISPATCH(panel_product)(matrix, first, last, frames, targets, frame_count);
}

const char* instruction_set() noexcept { return HWY_DYNAMIC_DISPATCH(instruction_set)(); }

}  // namespace skinbem::detail
#endif
