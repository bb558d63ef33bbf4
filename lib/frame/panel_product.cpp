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
#ifndef HWY_WANT_AVX3_DL
#define HWY_WANT_AVX3_DL  // has vpdpwssd
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

/// The shape of the work: kVectors vectors of adjacent vertices, kFrames frames at once. There is a sum for each frame,
/// component and vector. Where kTurns is above one, so many panels are read in turns, kBurst columns (or pairs of
/// columns) of each.
///
/// All loops over sums are expanded from index sequences: compilers keep an array in registers only where every index
/// is a constant from the outset.
template <std::size_t kVectors_, std::size_t kFrames_, std::size_t kTurns_ = 1>
struct Block {
  static constexpr std::size_t kVectors = kVectors_;
  static constexpr std::size_t kFrames = kFrames_;
  static constexpr std::size_t kTurns = kTurns_;
  static constexpr bool kInTurns = kTurns > 1;
  static constexpr std::size_t kBurst = 1;
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

/// How many columns (or pairs) before their turn.
constexpr std::size_t kAhead = 3;

/// Panels in single precision.
struct FloatPanels {
  // As many sums as registers allow: enough to hide the latency of the multiply-add, and in a batch each number of R
  // that is loaded serves several frames.
  static constexpr std::size_t kVectors = std::min<std::size_t>(4, kPanelWidth / kLanes);
  using SingleBlock = Block<kVectors, 1>;
  using TurnsBlock = Block<kVectors, 1, kPanelsInTurns>;
  using BatchBlock = Block<2, (kLanes >= 16 ? 4 : 2)>;

  /// `count` panels, at most B::kTurns: `first` and those `step` further each.
  template <class B, class MotionOf>
  static HWY_INLINE void evaluate(const PanelMatrix& matrix, std::size_t first, std::size_t step, std::size_t count,
                                  const FrameFactors* frames, const MotionOf& motion_of, const FrameTarget* targets) {
    if constexpr (!B::kInTurns) count = 1;
    HWY_ALIGN float sums[B::kTurns][B::kFrames * kColumnNumbers];
    const std::size_t columns = matrix.places[first].entries;
    std::size_t k = 0;
    do {
      const std::size_t end = B::kInTurns ? std::min(k + B::kBurst, columns) : columns;
      for (std::size_t turn = 0; turn < count; ++turn) {
        for (std::size_t shift = 0; shift < kPanelWidth; shift += B::kVertices) {
          add_columns<B>(matrix, first + turn * step, shift, k, end, frames, motion_of, targets, sums[turn] + shift,
                         std::make_index_sequence<B::kSums>(), std::make_index_sequence<B::kFrames>());
        }
      }
      k = end;
    } while (B::kInTurns && k < columns);
  }

 private:
  /// Columns [k, end) of a block. Its sums begin with the rest positions, are in `sums` between bursts, and after the
  /// last column become positions.
  template <class B, class MotionOf, std::size_t... kSum, std::size_t... kFrame>
  static HWY_INLINE void add_columns(const PanelMatrix& matrix, std::size_t panel, std::size_t shift, std::size_t k,
                                     std::size_t end, const FrameFactors* frames, const MotionOf& motion_of,
                                     const FrameTarget* targets, float* sums, std::index_sequence<kSum...>,
                                     std::index_sequence<kFrame...>) {
    const float* rest = reinterpret_cast<const float*>(matrix.data + matrix.places[panel].offset) + shift;
    Vector sum[B::kSums];
    if (!B::kInTurns || k == 0) {
      ((sum[kSum] = hn::Mul(hn::Set(Tag(), frames[B::frame(kSum)].rest), hn::Load(Tag(), rest + B::place(kSum)))), ...);
    } else {
      ((sum[kSum] = hn::Load(Tag(), sums + B::memory(kSum))), ...);
    }
    const float* column = rest + k * kColumnNumbers;
    for (; k < end; ++k) {
      column += kColumnNumbers;
      if constexpr (B::kInTurns) prefetch_block<B>(column + kAhead * kColumnNumbers);
      const Vector weight[] = {hn::Set(Tag(), frames[kFrame].weights[k])...};
      ((sum[kSum] = hn::MulAdd(hn::Load(Tag(), column + B::place(kSum)), weight[B::frame(kSum)], sum[kSum])), ...);
    }
    if (!B::kInTurns || end == matrix.places[panel].entries) {
      move_and_store_block<B>(sum, motion_of, targets, panel * kPanelWidth + shift, matrix.vertices,
                              std::make_index_sequence<B::kFrames * B::kVectors>());
    } else {
      (hn::Store(sum[kSum], Tag(), sums + B::memory(kSum)), ...);
    }
  }
};

using IntTag = hn::RebindToSigned<Tag>;
using IntVector = hn::Vec<IntTag>;

/// In each lane: sum + lower half times lower half + upper half times upper half.
HWY_INLINE IntVector add_pair_product(IntVector words, IntVector weights, IntVector sum) {
#if HWY_ARCH_X86 && HWY_TARGET <= HWY_AVX3_DL
  asm("vpdpwssd %2, %1, %0" : "+v"(sum.raw) : "v"(words.raw), "v"(weights.raw));
  return sum;
#elif HWY_ARCH_X86 && HWY_TARGET != HWY_EMU128 && HWY_TARGET != HWY_SCALAR
  const hn::RepartitionToNarrow<IntTag> pairs;
  IntVector unused = hn::Zero(IntTag());
  sum = hn::ReorderWidenMulAccumulate(IntTag(), hn::BitCast(pairs, words), hn::BitCast(pairs, weights), sum, unused);
  asm volatile("" : "+v"(sum.raw));  // one by one: GCC would take many products first and run out of registers
  return sum;
#else
  const auto lower = [](IntVector v) { return hn::ShiftRight<16>(hn::ShiftLeft<16>(v)); };
  sum = hn::Add(sum, hn::Mul(lower(words), lower(weights)));
  return hn::Add(sum, hn::Mul(hn::ShiftRight<16>(words), hn::ShiftRight<16>(weights)));
#endif
}

/// Panels in 16 bits. Weights, relative to the largest that may be, are integers too, of two parts with 11 bits each:
/// sums of 32 entries are exact in 32 bits.
struct QuantisedPanels {
  // Two integers in registers for every sum, one of each part.
  static constexpr std::size_t kVectors = kLanes >= 8 ? 2 : 1;
  using SingleBlock = Block<kVectors, 1>;
  using TurnsBlock = Block<kVectors, 1, kPanelsInTurns>;
  using BatchBlock = Block<(kLanes >= 16 ? 2 : 1), 2>;

  /// `count` panels, at most B::kTurns: `first` and those `step` further each.
  template <class B, class MotionOf>
  static HWY_INLINE void evaluate(const PanelMatrix& matrix, std::size_t first, std::size_t step, std::size_t count,
                                  const FrameFactors* frames, const MotionOf& motion_of, const FrameTarget* targets) {
    if constexpr (!B::kInTurns) count = 1;
    Panel<B> panels[B::kTurns];
    SplitWeights weights[B::kTurns][B::kFrames];
    Integers<B> integers[B::kTurns];
    HWY_ALIGN float sums[B::kTurns][B::kFrames * kColumnNumbers];
    std::size_t entries = 0;
    for (std::size_t turn = 0; turn < count; ++turn) {
      begin(matrix, first + turn * step, frames, panels[turn], sums[turn]);
      entries = std::max(entries, panels[turn].place->entries);
    }
    for (std::size_t k = 0; k < entries; k += kGroup) {
      for (std::size_t turn = 0; turn < count; ++turn) split_weights(k, frames, panels[turn], weights[turn]);
      for (std::size_t p = 0; p < kGroup / 2; p += B::kInTurns ? B::kBurst : kGroup / 2) {
        for (std::size_t turn = 0; turn < count; ++turn) {
          add_burst(k, p, weights[turn], panels[turn], integers[turn], sums[turn]);
        }
      }
    }
    for (std::size_t turn = 0; turn < count; ++turn) {
      for (std::size_t shift = 0; shift < kPanelWidth; shift += B::kVertices) {
        store_block<B>(sums[turn] + shift, motion_of, targets, (first + turn * step) * kPanelWidth + shift,
                       matrix.vertices, std::make_index_sequence<B::kSums>());
      }
    }
  }

 private:
  static constexpr std::size_t kGroup = 32;
  static constexpr int kPartBits = 11;
  static constexpr float kHigh = 1 << kPartBits;

  /// What of a panel is still to be added.
  template <class B>
  struct Panel {
    const PanelPlace* place;
    const float* scale;
    const std::int32_t* words;  ///< of the next pair of entries
    float unit[B::kFrames];     ///< of the integers
  };

  /// Of a group of entries: a weight is high kHigh + low.
  struct SplitWeights {
    HWY_ALIGN std::int16_t high[kGroup];
    HWY_ALIGN std::int16_t low[kGroup];
  };

  /// Sums of a group of entries by the parts of its weights.
  template <class B>
  struct Integers {
    HWY_ALIGN std::int32_t high[B::kFrames * kColumnNumbers];
    HWY_ALIGN std::int32_t low[B::kFrames * kColumnNumbers];
  };

  template <class B>
  static HWY_INLINE void begin(const PanelMatrix& matrix, std::size_t index, const FrameFactors* frames,
                               Panel<B>& panel, float* sums) {
    const PanelPlace& place = matrix.places[index];
    const auto* rest = reinterpret_cast<const float*>(matrix.data + place.offset);
    panel.place = &place;
    panel.scale = rest + kColumnNumbers;
    panel.words = reinterpret_cast<const std::int32_t*>(matrix.data + place.offset + kRestBytes +
                                                        entry_list_bytes(place.entries, place.adjacent));
    for (std::size_t f = 0; f < B::kFrames; ++f) {
      panel.unit[f] = place.scale * frames[f].weight_limit / (kHigh * kHigh);
      for (std::size_t i = 0; i < kColumnNumbers; i += kLanes) {
        hn::Store(hn::Mul(hn::Set(Tag(), frames[f].rest), hn::Load(Tag(), rest + i)), Tag(),
                  sums + f * kColumnNumbers + i);
      }
    }
  }

  /// Of the group that begins with `entry`.
  template <class B>
  static HWY_INLINE void split_weights(std::size_t entry, const FrameFactors* frames, const Panel<B>& panel,
                                       SplitWeights* weights_of) {
    const PanelPlace& place = *panel.place;
    const auto* which = reinterpret_cast<const std::int32_t*>(panel.scale + padded_entries(place.entries));
    const IntVector half = hn::Set(IntTag(), 1 << (kPartBits - 1));
    const hn::Rebind<std::int16_t, Tag> parts;
    for (std::size_t f = 0; f < B::kFrames; ++f) {
      const Vector steps = hn::Set(Tag(), kHigh * kHigh / frames[f].weight_limit);
      for (std::size_t k = 0; k < kGroup && entry + k < place.entries; k += kLanes) {
        const std::size_t first = entry + k;
        const Vector weights =
            first < place.adjacent
                ? hn::LoadU(Tag(), frames[f].weights + place.column + first)
                : hn::GatherIndex(Tag(), frames[f].weights, hn::Load(IntTag(), which + first - place.adjacent));
        const IntVector weight = hn::NearestInt(hn::Mul(hn::Mul(hn::Load(Tag(), panel.scale + first), steps), weights));
        const IntVector high = hn::ShiftRight<kPartBits>(hn::Add(weight, half));
        hn::Store(hn::DemoteTo(parts, high), parts, weights_of[f].high + k);
        hn::Store(hn::DemoteTo(parts, hn::Sub(weight, hn::ShiftLeft<kPartBits>(high))), parts, weights_of[f].low + k);
      }
    }
  }

  /// The burst from pair p on of the group that begins with `entry`.
  template <class B>
  static HWY_INLINE void add_burst(std::size_t entry, std::size_t p, const SplitWeights* weights, Panel<B>& panel,
                                   Integers<B>& integers, float* sums) {
    const std::size_t entries = panel.place->entries;
    if (B::kInTurns && entry + 2 * p >= entries) return;
    const std::size_t pairs = (std::min(kGroup, entries - entry) + 1) / 2;
    const std::size_t end = B::kInTurns ? std::min(p + B::kBurst, pairs) : pairs;
    for (std::size_t shift = 0; shift < kPanelWidth; shift += B::kVertices) {
      add_pairs<B>(p, end, pairs, shift, weights, panel, integers, sums, std::make_index_sequence<B::kSums>(),
                   std::make_index_sequence<B::kFrames>());
    }
    panel.words += (end - p) * kColumnNumbers;
  }

  /// The parts of two entries in every lane.
  static HWY_INLINE IntVector pair(const std::int16_t* parts) {
    std::int32_t word;
    std::memcpy(&word, parts, sizeof(word));
    return hn::Set(IntTag(), word);
  }

  /// Pairs [p, end) of a block: integers that begin with zero, are in memory between bursts, and after the last pair of
  /// the group join the sums.
  template <class B, std::size_t... kSum, std::size_t... kFrame>
  static HWY_INLINE void add_pairs(std::size_t p, std::size_t end, std::size_t pairs, std::size_t shift,
                                   const SplitWeights* weights, const Panel<B>& panel, Integers<B>& integers,
                                   float* sums, std::index_sequence<kSum...>, std::index_sequence<kFrame...>) {
    IntVector high[B::kSums];
    IntVector low[B::kSums];
    const auto in_memory = [&](auto* first, std::size_t sum) { return first + B::memory(sum) + shift; };
    if (!B::kInTurns || p == 0) {
      ((high[kSum] = hn::Zero(IntTag()), low[kSum] = hn::Zero(IntTag())), ...);
    } else {
      ((high[kSum] = hn::Load(IntTag(), in_memory(integers.high, kSum)),
        low[kSum] = hn::Load(IntTag(), in_memory(integers.low, kSum))),
       ...);
    }
    const std::int32_t* words = panel.words + shift;
    for (; p < end; ++p, words += kColumnNumbers) {
      if constexpr (B::kInTurns) {
        prefetch_block<B>(words + kAhead * kColumnNumbers);
      } else if constexpr (B::kVertices < kPanelWidth) {
        prefetch_block<B>(words + B::kVertices);  // what the next block reads, so that the stream has no gaps
      }
      const IntVector high_pair[] = {pair(weights[kFrame].high + 2 * p)...};
      const IntVector low_pair[] = {pair(weights[kFrame].low + 2 * p)...};
      ((high[kSum] =
            add_pair_product(hn::Load(IntTag(), words + B::place(kSum)), high_pair[B::frame(kSum)], high[kSum]),
        low[kSum] = add_pair_product(hn::Load(IntTag(), words + B::place(kSum)), low_pair[B::frame(kSum)], low[kSum])),
       ...);
    }
    if (B::kInTurns && end < pairs) {
      ((hn::Store(high[kSum], IntTag(), in_memory(integers.high, kSum)),
        hn::Store(low[kSum], IntTag(), in_memory(integers.low, kSum))),
       ...);
      return;
    }
    const auto add = [&](IntVector high_sum, IntVector low_sum, float unit, float* to) {
      const Vector sum =
          hn::MulAdd(hn::Set(Tag(), kHigh), hn::ConvertTo(Tag(), high_sum), hn::ConvertTo(Tag(), low_sum));
      hn::Store(hn::MulAdd(hn::Set(Tag(), unit), sum, hn::Load(Tag(), to)), Tag(), to);
    };
    (add(high[kSum], low[kSum], panel.unit[B::frame(kSum)], in_memory(sums, kSum)), ...);
  }

  template <class B, class MotionOf, std::size_t... kSum>
  static HWY_INLINE void store_block(const float* sums, const MotionOf& motion_of, const FrameTarget* targets,
                                     std::size_t vertex, std::size_t vertices, std::index_sequence<kSum...>) {
    const Vector sum[] = {hn::Load(Tag(), sums + B::memory(kSum))...};
    move_and_store_block<B>(sum, motion_of, targets, vertex, vertices,
                            std::make_index_sequence<B::kFrames * B::kVectors>());
  }
};

/// One frame: its motion stays in registers from panel to panel, for which it must not share them with batches.
template <class Panels, class B>
HWY_NOINLINE void evaluate_single(const PanelMatrix& matrix, std::size_t first, std::size_t last,
                                  const FrameFactors& frame, const FrameTarget& target) {
  const Motion motion(frame);
  const auto motion_of = [&](std::size_t) -> const Motion& { return motion; };
  const std::size_t part = (last - first) / B::kTurns;  // each is read as one stream
  for (std::size_t panel = first; panel < first + part; ++panel) {
    Panels::template evaluate<B>(matrix, panel, part, B::kTurns, &frame, motion_of, &target);
  }
  const std::size_t left = first + part * B::kTurns;
  if (left < last) Panels::template evaluate<B>(matrix, left, 1, last - left, &frame, motion_of, &target);
}

template <class Panels>
HWY_INLINE void evaluate_panels(const PanelMatrix& matrix, std::size_t first, std::size_t last,
                                const FrameFactors* frames, const FrameTarget* targets, std::size_t frame_count) {
  using Single = typename Panels::SingleBlock;
  using Batch = typename Panels::BatchBlock;
  if (frame_count == 1) {
    const auto evaluate =
        matrix.from_memory ? evaluate_single<Panels, typename Panels::TurnsBlock> : evaluate_single<Panels, Single>;
    evaluate(matrix, first, last, *frames, *targets);
    return;
  }
  for (std::size_t panel = first; panel < last; ++panel) {
    std::size_t f = 0;
    const auto motion_of = [&](std::size_t i) { return Motion(frames[f + i]); };
    for (; f + Batch::kFrames <= frame_count; f += Batch::kFrames) {
      Panels::template evaluate<Batch>(matrix, panel, 1, 1, frames + f, motion_of, targets + f);
    }
    for (; f < frame_count; ++f) {
      Panels::template evaluate<Single>(matrix, panel, 1, 1, frames + f, motion_of, targets + f);
    }
  }
}

void panel_product(const PanelMatrix& matrix, std::size_t first, std::size_t last, const FrameFactors* frames,
                   const FrameTarget* targets, std::size_t frame_count) {
  if (matrix.quantised) {
    evaluate_panels<QuantisedPanels>(matrix, first, last, frames, targets, frame_count);
  } else {
    evaluate_panels<FloatPanels>(matrix, first, last, frames, targets, frame_count);
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
