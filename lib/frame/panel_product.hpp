// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The kernel of a frame: y = Q (X + R q) + t over panels of vertices, SIMD with run-time dispatch. Internal to the
/// floor; FrameModel and FrameState are what a user sees.
#pragma once

#include <cstddef>
#include <cstdint>

namespace skinbem::detail {

/// Vertices a panel: whole vectors of every instruction set up to 512 bit, and little padding on small skins.
inline constexpr std::size_t kPanelWidth = 32;
inline constexpr std::size_t kHalfPanel = kPanelWidth / 2;
/// Numbers of one column of a panel: x of 32 vertices, then y, then z.
inline constexpr std::size_t kColumnNumbers = 3 * kPanelWidth;

/// Panels read in turns: from memory, a core of some machines reads several places faster than one.
inline constexpr std::size_t kPanelsInTurns = 8;

/// Where a panel begins and how many entries (columns, or parts of columns) it has. The rest is for quantised panels.
struct PanelPlace {
  std::size_t offset = 0;  ///< bytes, a multiple of 64
  std::size_t entries = 0;
  std::uint32_t adjacent = 0;  ///< first entries that belong to columns in order: all, or whole lines of 16
  std::uint32_t column = 0;    ///< of the first of them
  float scale = 1;             ///< those of the entries are relative to it: a power of two
};

/// [X R] by panels of 32 vertices, one after the other in memory; padding vertices are zero. A panel is
///   float    rest[96]
/// then, in single precision, for every column of R
///   float    column[96]
/// or, quantised, for every entry (a column where a panel needs it; twice, as value and remainder, where it needs that)
///   float    scale, padded by zeros to whole lines of 64 bytes
/// for those that are not adjacent
///   uint32   which column, padded likewise
/// and for every two entries
///   int32    words[96]
/// of which word i holds number i of the first entry in its lower half and of the second in its upper half (zero where
/// there is none): the form in which processors multiply 16-bit numbers by pairs and add.
struct PanelMatrix {
  const std::byte* data = nullptr;  ///< 64-byte aligned
  const PanelPlace* places = nullptr;
  std::size_t vertices = 0;
  bool quantised = false;
  bool in_turns = false;  ///< single frames read kPanelsInTurns panels in turns (reading_order.hpp). The same bits.

  std::size_t panels() const { return (vertices + kPanelWidth - 1) / kPanelWidth; }
};

/// Bytes of the rest positions, of two quantised columns, and of the list of entries.
inline constexpr std::size_t kRestBytes = kColumnNumbers * sizeof(float);
inline constexpr std::size_t kColumnPairBytes = kColumnNumbers * sizeof(std::int32_t);
/// Entries as many as fill whole lines in their list.
constexpr std::size_t padded_entries(std::size_t entries) { return (entries + 15) / 16 * 16; }
constexpr std::size_t entry_list_bytes(std::size_t entries, std::size_t adjacent) {
  return padded_entries(entries) * sizeof(float) + padded_entries(entries - adjacent) * sizeof(std::uint32_t);
}

/// What changes from frame to frame. Rotation and translation are repeated for 16 vertices, so that an aligned vector
/// load gives each lane of interleaved coordinates its own row.
struct FrameFactors {
  static constexpr std::size_t kRepeated = 3 * kHalfPanel;

  const float* weights = nullptr;            ///< q, one a column, in memory from make_weights where R is quantised
  float weight_limit = 1;                    ///< a power of two above all of them
  float rest = 1;                            ///< times the rest positions
  alignas(64) float rotation[3][kRepeated];  ///< rotation[j][i] = Q(i mod 3, j)
  alignas(64) float translation[kRepeated];  ///< t(i mod 3)
};

/// Where a frame goes: the i-th position is written to data[v * stride + 0, 1, 2] with v = order[i], or i where there
/// is no order.
struct FrameTarget {
  float* data = nullptr;
  std::size_t stride = 3;
  const std::uint32_t* order = nullptr;
};

/// Evaluates `frame_count` frames on the panels [first, last). Each number is summed in the order of the columns
/// whatever the range and the number of frames, so results are the same bits for any division of the work.
void panel_product(const PanelMatrix& matrix, std::size_t first, std::size_t last, const FrameFactors* frames,
                   const FrameTarget* targets, std::size_t frame_count) noexcept;

/// Name of the instruction set that panel_product uses on this machine.
const char* instruction_set() noexcept;

}  // namespace skinbem::detail
