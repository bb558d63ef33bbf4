// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/frame/panel_product.hpp>

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
#include <skinbem/frame/float_panels-inl.hpp>
#include <skinbem/frame/quantised_panels-inl.hpp>

HWY_BEFORE_NAMESPACE();
namespace skinbem::detail {
namespace HWY_NAMESPACE {

/// One frame: its motion stays in registers from panel to panel, for which it must not share them with batches.
template <class Panels, class B>
HWY_NOINLINE void evaluate_single(const PanelMatrix& matrix, std::size_t first, std::size_t last,
                                  const FrameFactors& frame, const FrameTarget& target) {
  const Motion motion(frame);
  const auto motion_of = [&](std::size_t) -> const Motion& { return motion; };
  const std::size_t part = (last - first) / B::kPanels;  // each is read as one stream
  for (std::size_t panel = first; panel < first + part; ++panel) {
    Panels::template evaluate<B>(matrix, panel, part, B::kPanels, &frame, motion_of, &target);
  }
  const std::size_t left = first + part * B::kPanels;
  if (left < last) Panels::template evaluate<B>(matrix, left, 1, last - left, &frame, motion_of, &target);
}

template <class Panels>
HWY_INLINE void evaluate_panels(const PanelMatrix& matrix, std::size_t first, std::size_t last,
                                const FrameFactors* frames, const FrameTarget* targets, std::size_t frame_count) {
  using Single = typename Panels::SingleBlock;
  using Batch = typename Panels::BatchBlock;
  if (frame_count == 1) {
    const auto evaluate =
        matrix.in_turns ? evaluate_single<Panels, typename Panels::TurnsBlock> : evaluate_single<Panels, Single>;
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
