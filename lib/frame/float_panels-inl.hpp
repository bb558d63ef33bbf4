// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Panels in single precision. Internal to panel_product.cpp.
// Read once for every instruction set, as Highway does it.
#if defined(SKINBEM_FRAME_FLOAT_PANELS_INL) == defined(HWY_TARGET_TOGGLE)
#ifdef SKINBEM_FRAME_FLOAT_PANELS_INL
#undef SKINBEM_FRAME_FLOAT_PANELS_INL
#else
#define SKINBEM_FRAME_FLOAT_PANELS_INL
#endif

#include <skinbem/frame/panel_blocks-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace skinbem::detail::HWY_NAMESPACE {

/// Panels in single precision.
struct FloatPanels {
  // As many sums as registers allow: enough to hide the latency of the multiply-add, and in a batch each number of R
  // that is loaded serves several frames.
  static constexpr std::size_t kVectors = std::min<std::size_t>(4, kPanelWidth / kLanes);
  using SingleBlock = Block<kVectors, 1>;
  using TurnsBlock = Block<kVectors, 1, kPanelsInTurns, true>;
  using BatchBlock = Block<2, (kLanes >= 16 ? 4 : 2)>;

  /// `count` panels, at most B::kPanels: `first` and those `step` further each.
  template <class B, class MotionOf>
  static HWY_INLINE void evaluate(const PanelMatrix& matrix, std::size_t first, std::size_t step, std::size_t count,
                                  const FrameFactors* frames, const MotionOf& motion_of, const FrameTarget* targets) {
    if constexpr (B::kPanels == 1) count = 1;  // known to the compiler
    HWY_ALIGN float sums[B::kPanels][B::kFrames * kColumnNumbers];
    const std::size_t columns = matrix.places[first].entries;
    std::size_t k = 0;
    do {
      const std::size_t end = B::kInTurns ? std::min(k + 1, columns) : columns;
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
  /// One column. Each number of it is loaded once for all frames: compilers, given the choice, load it again for every
  /// frame, as an operand of the multiply-add, and loads then take longer than arithmetic.
  template <class B, std::size_t... kNumber>
  static HWY_INLINE void add_column(const float* column, const Vector (&weight)[B::kFrames], Vector (&sum)[B::kSums],
                                    std::index_sequence<kNumber...>) {
    (add_number<B, kNumber>(column, weight, sum, std::make_index_sequence<B::kFrames>()), ...);
  }

  template <class B, std::size_t kNumber, std::size_t... kFrame>
  static HWY_INLINE void add_number(const float* column, const Vector (&weight)[B::kFrames], Vector (&sum)[B::kSums],
                                    std::index_sequence<kFrame...>) {
    constexpr std::size_t c = kNumber / B::kVectors, v = kNumber % B::kVectors;
    Vector number = hn::Load(Tag(), column + B::place(kNumber));
    if constexpr (B::kFrames > 1) keep_in_register(number);
    ((sum[B::sum(kFrame, c, v)] = hn::MulAdd(number, weight[kFrame], sum[B::sum(kFrame, c, v)])), ...);
  }

  /// Columns [k, end) of a block. Its sums begin with the rest positions, are in `sums` between turns, and after the
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
      add_column<B>(column, weight, sum, std::make_index_sequence<3 * B::kVectors>());
    }
    if (!B::kInTurns || end == matrix.places[panel].entries) {
      move_and_store_block<B>(sum, motion_of, targets, panel * kPanelWidth + shift, matrix.vertices,
                              std::make_index_sequence<B::kFrames * B::kVectors>());
    } else {
      (hn::Store(sum[kSum], Tag(), sums + B::memory(kSum)), ...);
    }
  }
};

}  // namespace skinbem::detail::HWY_NAMESPACE
HWY_AFTER_NAMESPACE();

#endif
