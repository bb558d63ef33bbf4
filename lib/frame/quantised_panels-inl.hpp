// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Panels in 16 bits, multiplied by integer weights. Internal to panel_product.cpp.
// Read once for every instruction set, as Highway does it.
#if defined(SKINBEM_FRAME_QUANTISED_PANELS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SKINBEM_FRAME_QUANTISED_PANELS_INL
#undef SKINBEM_FRAME_QUANTISED_PANELS_INL
#else
#define SKINBEM_FRAME_QUANTISED_PANELS_INL
#endif

#include <skinbem/frame/panel_blocks-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace skinbem::detail::HWY_NAMESPACE {

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
  keep_in_register(sum);  // one by one: GCC would take many products first and run out of registers
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
  // Two panels: the weights of the second are split while the products of the first are under way.
  using SingleBlock = Block<kVectors, 1, 2>;
  using TurnsBlock = Block<kVectors, 1, kPanelsInTurns, true>;
  using BatchBlock = Block<(kLanes >= 16 ? 2 : 1), 2>;

  /// `count` panels, at most B::kPanels: `first` and those `step` further each.
  template <class B, class MotionOf>
  static HWY_INLINE void evaluate(const PanelMatrix& matrix, std::size_t first, std::size_t step, std::size_t count,
                                  const FrameFactors* frames, const MotionOf& motion_of, const FrameTarget* targets) {
    if constexpr (B::kPanels == 1) count = 1;  // known to the compiler
    Panel<B> panels[B::kPanels];
    SplitWeights weights[B::kPanels][B::kFrames];
    Integers<B> integers[B::kPanels];
    HWY_ALIGN float sums[B::kPanels][B::kFrames * kColumnNumbers];
    std::size_t entries = 0;
    for (std::size_t turn = 0; turn < count; ++turn) {
      begin(matrix, first + turn * step, frames, panels[turn], sums[turn]);
      entries = std::max(entries, panels[turn].place->entries);
    }
    for (std::size_t k = 0; k < entries; k += kGroup) {
      for (std::size_t turn = 0; turn < count; ++turn) split_weights(k, frames, panels[turn], weights[turn]);
      for (std::size_t p = 0; p < kGroup / 2; p += B::kInTurns ? 1 : kGroup / 2) {
        for (std::size_t turn = 0; turn < count; ++turn) {
          add_turn(k, p, weights[turn], panels[turn], integers[turn], sums[turn]);
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

  /// The integer nearest to a product of at most 2^22, from the bits of a float whose last one counts one.
  static HWY_INLINE IntVector rounded_product(Vector a, Vector b) {
    const Vector shift = hn::Set(Tag(), 0x1.8p23F);
    return hn::Sub(hn::BitCast(IntTag(), hn::MulAdd(a, b, shift)), hn::BitCast(IntTag(), shift));
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
        const IntVector weight = rounded_product(hn::Mul(hn::Load(Tag(), panel.scale + first), steps), weights);
        const IntVector high = hn::ShiftRight<kPartBits>(hn::Add(weight, half));
        hn::Store(hn::DemoteTo(parts, high), parts, weights_of[f].high + k);
        hn::Store(hn::DemoteTo(parts, hn::Sub(weight, hn::ShiftLeft<kPartBits>(high))), parts, weights_of[f].low + k);
      }
    }
  }

  /// From pair p on of the group that begins with `entry`: in turns one pair, otherwise all.
  template <class B>
  static HWY_INLINE void add_turn(std::size_t entry, std::size_t p, const SplitWeights* weights, Panel<B>& panel,
                                  Integers<B>& integers, float* sums) {
    const std::size_t entries = panel.place->entries;
    if (B::kPanels > 1 && entry + 2 * p >= entries) return;  // the other panels have more
    const std::size_t pairs = (std::min(kGroup, entries - entry) + 1) / 2;
    const std::size_t end = B::kInTurns ? p + 1 : pairs;
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

  /// Pairs [p, end) of a block: integers that begin with zero, are in memory between turns, and after the last pair of
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

}  // namespace skinbem::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
