// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/frame/panel_product.hpp>

#include <algorithm>

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

using Tag = hn::CappedTag<float, kPanelWidth>;
using Vector = hn::Vec<Tag>;
constexpr std::size_t kLanes = hn::MaxLanes(Tag());

/// Writes `count` positions given as x, y, z of whole blocks; the general case of a stride or a ragged end.
template <std::size_t kVectors>
HWY_INLINE void store_scattered(const Vector (&position)[3][kVectors], std::size_t count, FrameTarget target) {
  const Tag d;
  HWY_ALIGN float packed[3][kVectors * kLanes];
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t v = 0; v < kVectors; ++v) hn::Store(position[c][v], d, packed[c] + v * kLanes);
  }
  for (std::size_t i = 0; i < count; ++i) {
    for (std::size_t c = 0; c < 3; ++c) target.data[i * target.stride + c] = packed[c][i];
  }
}

/// Q (.) + t of a block in registers, then to memory.
template <std::size_t kVectors>
HWY_INLINE void move_and_store(const Vector (&sum)[3][kVectors], const FrameFactors& frame, std::size_t count,
                               FrameTarget target) {
  const Tag d;
  Vector position[3][kVectors];
  for (std::size_t c = 0; c < 3; ++c) {
    const float* q = frame.rotation + 3 * c;
    for (std::size_t v = 0; v < kVectors; ++v) {
      const Vector x = hn::MulAdd(hn::Set(d, q[0]), sum[0][v], hn::Set(d, frame.translation[c]));
      position[c][v] = hn::MulAdd(hn::Set(d, q[2]), sum[2][v], hn::MulAdd(hn::Set(d, q[1]), sum[1][v], x));
    }
  }
  if (target.stride != 3 || count < kVectors * kLanes) return store_scattered(position, count, target);
  for (std::size_t v = 0; v < kVectors; ++v) {
    hn::StoreInterleaved3(position[0][v], position[1][v], position[2][v], d, target.data + 3 * v * kLanes);
  }
}

/// kFrames frames of one block of kVectors * kLanes vertices; `block` is its first float in column 0.
template <std::size_t kVectors, std::size_t kFrames>
HWY_INLINE void evaluate_block(const float* HWY_RESTRICT block, std::size_t columns, const FrameFactors* frames,
                               std::size_t count, const FrameTarget* targets, std::size_t first_vertex) {
  const Tag d;
  Vector sum[kFrames][3][kVectors];
  for (std::size_t c = 0; c < 3; ++c) {
    for (std::size_t v = 0; v < kVectors; ++v) {
      const Vector rest = hn::Load(d, block + c * kPanelWidth + v * kLanes);
      for (std::size_t f = 0; f < kFrames; ++f) sum[f][c][v] = rest;
    }
  }
  const float* weights[kFrames];
  for (std::size_t f = 0; f < kFrames; ++f) weights[f] = frames[f].weights;
  for (std::size_t k = 0; k < columns; ++k) {
    block += kColumnFloats;
    Vector weight[kFrames];
    for (std::size_t f = 0; f < kFrames; ++f) weight[f] = hn::Set(d, weights[f][k]);
    for (std::size_t c = 0; c < 3; ++c) {
      for (std::size_t v = 0; v < kVectors; ++v) {
        const Vector r = hn::Load(d, block + c * kPanelWidth + v * kLanes);
        for (std::size_t f = 0; f < kFrames; ++f) sum[f][c][v] = hn::MulAdd(r, weight[f], sum[f][c][v]);
      }
    }
  }
  for (std::size_t f = 0; f < kFrames; ++f) {
    const FrameTarget to = {targets[f].data + first_vertex * targets[f].stride, targets[f].stride};
    move_and_store<kVectors>(sum[f], frames[f], count, to);
  }
}

template <std::size_t kVectors, std::size_t kFrames>
HWY_INLINE void evaluate_panel(const PanelMatrix& matrix, std::size_t panel, const FrameFactors* frames,
                               const FrameTarget* targets) {
  constexpr std::size_t kBlock = kVectors * kLanes;
  const float* data = matrix.data + panel * matrix.panel_floats();
  const std::size_t begin = panel * kPanelWidth;
  const std::size_t end = std::min(begin + kPanelWidth, matrix.vertices);
  for (std::size_t vertex = begin; vertex < end; vertex += kBlock) {
    evaluate_block<kVectors, kFrames>(data + (vertex - begin), matrix.columns, frames, std::min(kBlock, end - vertex),
                                      targets, vertex);
  }
}

// As many sums as registers allow: enough to hide the latency of the multiply-add, and in a batch each number of R that
// is loaded serves several frames.
constexpr std::size_t kSingleVectors = std::min<std::size_t>(4, kPanelWidth / kLanes);
constexpr std::size_t kBatchVectors = std::min<std::size_t>(2, kSingleVectors);
constexpr std::size_t kBatchFrames = kLanes >= 16 ? 4 : 2;

void panel_product(const PanelMatrix& matrix, std::size_t first, std::size_t last, const FrameFactors* frames,
                   const FrameTarget* targets, std::size_t frame_count) {
  for (std::size_t panel = first; panel < last; ++panel) {
    std::size_t f = 0;
    for (; f + kBatchFrames <= frame_count; f += kBatchFrames) {
      evaluate_panel<kBatchVectors, kBatchFrames>(matrix, panel, frames + f, targets + f);
    }
    for (; f < frame_count; ++f) evaluate_panel<kSingleVectors, 1>(matrix, panel, frames + f, targets + f);
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
