// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Helpers for large skins: threads that join a frame while it runs.
#pragma once

#include <memory>
#include <optional>

#include <skinbem/frame/panel_product.hpp>

namespace skinbem {

/// Threads that help with frames (FrameState::evaluate). The calling thread never waits for a helper to begin: it works
/// through the skin from the front while helpers that are awake take pieces from the back, and at the end waits only
/// for pieces already begun. Per frame there is no lock, no system call and no allocation. Helpers that make frames
/// slower than they are alone, late on a busy core or on the caller's own, are not asked again until what was lost is a
/// small share of the time; one frame in 512 is evaluated alone for comparison. Helpers spin for 100 us after a frame,
/// then look for the next one less and less often, at last every millisecond: frames one after the other have help, a
/// single frame now and then has not.
///
/// One object serves any number of states; while it works for one thread, others evaluate alone. The result has the
/// same bits whoever helps.
class FrameThreads {
 public:
  /// `threads` in all, the caller among them; 0: as many as the machine has. `least_bytes`: models that take fewer are
  /// evaluated by the caller alone; where it is not given, the size from which help pays is measured, in 5 to 10
  /// milliseconds, longer beside busy programs. Throws Error(usage) for a negative number.
  explicit FrameThreads(int threads = 0, std::optional<std::size_t> least_bytes = {});
  /// Waits for the helpers to end, about a millisecond.
  ~FrameThreads();
  FrameThreads(const FrameThreads&) = delete;
  FrameThreads& operator=(const FrameThreads&) = delete;

  int count() const noexcept;
  /// Bytes of a model from which on others help: 64 KiB to 4 MiB where it was measured, 1 MiB where the cores were too
  /// busy to measure it, the largest number for one thread.
  std::size_t least_bytes() const noexcept;

  /// All panels of one frame. What FrameState::evaluate calls.
  void run(const detail::PanelMatrix& matrix, std::size_t bytes, const detail::FrameFactors& frame,
           const detail::FrameTarget& target) noexcept;

 private:
  void measure_least_bytes();

  struct Crew;
  std::unique_ptr<Crew> crew_;
};

}  // namespace skinbem
