// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/frame/panel_product.hpp>

#include <algorithm>
#include <array>
#include <utility>

// Vectors of a length unknown at compile time cannot be array elements; such machines use their fixed-length set.
#ifndef HWY_DISABLED_TARGETS
#define HWY_DISABLED_TARGETS (HWY_RVV | HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128)
#endif
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "skinbem/frame/panel_product.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h comes first
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
        column(reinterpret_cast<const std::int32_t*>(panel + kRestBytes + entry_list_bytes(entries))) {}
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

/// Q (.) + t of the vertices from `vertex` on, and to memory with x, y, z adjacent. The interleaving is part of the
/// rotation: each output vector takes the three coordinates of its lanes' vertices, times the lanes' rows of Q.
HWY_INLINE void move_and_store(Vector x, Vector y, Vector z, const FrameFactors& frame, const FrameTarget& target,
                               std::size_t vertex, std::size_t vertices) {
  if (vertex >= vertices) return;
  const Tag d;
  Vector position[3];
  for (std::size_t m = 0; m < 3; ++m) {
    const auto lane_vertices = hn::SetTableIndices(d, kLaneVertices.data() + m * kLanes);
    Vector sum = hn::Load(d, frame.translation + m * kLanes);
    sum = hn::MulAdd(hn::Load(d, frame.rotation[0] + m * kLanes), hn::TableLookupLanes(x, lane_vertices), sum);
    sum = hn::MulAdd(hn::Load(d, frame.rotation[1] + m * kLanes), hn::TableLookupLanes(y, lane_vertices), sum);
    position[m] = hn::MulAdd(hn::Load(d, frame.rotation[2] + m * kLanes), hn::TableLookupLanes(z, lane_vertices), sum);
  }
  const std::size_t count = std::min(kLanes, vertices - vertex);
  float* to = target.data + vertex * target.stride;
  if (target.stride == 3 && count == kLanes) {
    for (std::size_t m = 0; m < 3; ++m) hn::StoreU(position[m], d, to + m * kLanes);
    return;
  }
  HWY_ALIGN float packed[3 * kLanes];
  for (std::size_t m = 0; m < 3; ++m) hn::Store(position[m], d, packed + m * kLanes);
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < 3; ++c) to[i * target.stride + c] = packed[3 * i + c];
  }
}

/// The part of a panel that begins `shift` vertices into it.
template <class B, class Columns, std::size_t... kSum, std::size_t... kFrame, std::size_t... kPosition,
          std::size_t... kLine>
HWY_INLINE void evaluate_block(const PanelMatrix& matrix, std::size_t panel, std::size_t shift,
                               const FrameFactors* frames, const FrameTarget* targets, std::index_sequence<kSum...>,
                               std::index_sequence<kFrame...>, std::index_sequence<kPosition...>) {
  const std::byte* data = matrix.data + matrix.places[panel].offset;
  const std::size_t entries = matrix.places[panel].entries;
  const Columns columns(data, entries);
  const auto* column = columns.column + shift;
  Vector sum[] = {numbers<B>(reinterpret_cast<const float*>(data) + shift, kSum)...};
  for (std::size_t k = 0; k < entries; ++k, column += Columns::kStep) {
    const Vector weight[] = {hn::Set(Tag(), columns.weight(frames[kFrame], k))...};
    ((sum[kSum] = hn::MulAdd(numbers<B>(column, kSum), weight[B::frame(kSum)], sum[kSum])), ...);
  }
  const std::size_t first = panel * kPanelWidth + shift;
  (move_and_store(sum[B::sum(kPosition / B::kVectors, 0, kPosition % B::kVectors)],
                  sum[B::sum(kPosition / B::kVectors, 1, kPosition % B::kVectors)],
                  sum[B::sum(kPosition / B::kVectors, 2, kPosition % B::kVectors)], frames[kPosition / B::kVectors],
                  targets[kPosition / B::kVectors], first + B::begin(kPosition % B::kVectors), matrix.vertices),
   ...);
}

template <class B, class Columns>
HWY_INLINE void evaluate_panel(const PanelMatrix& matrix, std::size_t panel, const FrameFactors* frames,
                               const FrameTarget* targets) {
  for (std::size_t shift = 0; shift < kHalfPanel; shift += B::kVertices) {
    evaluate_block<B, Columns>(matrix, panel, shift, frames, targets, std::make_index_sequence<B::kSums>(),
                               std::make_index_sequence<B::kFrames>(),
                               std::make_index_sequence<B::kFrames * B::kVectors>());
  }
}

// As many sums as registers allow: enough to hide the latency of the multiply-add, and in a batch each number of R that
// is loaded serves several frames.
using SingleBlock = Block<std::min<std::size_t>(4, kPanelWidth / kLanes), 1>;
using BatchBlock = Block<2, (kLanes >= 16 ? 4 : 2)>;

template <class Columns>
HWY_INLINE void evaluate_panels(const PanelMatrix& matrix, std::size_t first, std::size_t last,
                                const FrameFactors* frames, const FrameTarget* targets, std::size_t frame_count) {
  for (std::size_t panel = first; panel < last; ++panel) {
    std::size_t f = 0;
    for (; f + BatchBlock::kFrames <= frame_count; f += BatchBlock::kFrames) {
      evaluate_panel<BatchBlock, Columns>(matrix, panel, frames + f, targets + f);
    }
    for (; f < frame_count; ++f) evaluate_panel<SingleBlock, Columns>(matrix, panel, frames + f, targets + f);
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
