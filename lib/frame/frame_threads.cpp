// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/frame/frame_threads.hpp>

#include <algorithm>
#include <atomic>
#include <chrono>
#include <cstdint>
#include <limits>
#include <string>
#include <thread>
#include <vector>

#include <skinbem/base/aligned_buffer.hpp>
#include <skinbem/base/error.hpp>

#if defined(__x86_64__) || defined(__i386__)
#include <immintrin.h>
#endif

namespace skinbem {
namespace {

using Clock = std::chrono::steady_clock;

/// A piece is about this many bytes: some microseconds, so that the wait at the end is short.
constexpr std::size_t kPieceBytes = 64 * 1024;
/// Share of the time that late helpers may cost, and the wait that counts as late.
constexpr double kLateShare = 0.1;
constexpr double kLateSeconds = 20e-6;
/// One frame in so many is evaluated alone, to know what help gains.
constexpr std::uint32_t kFramesToCompare = 64;
/// No model is as large.
constexpr std::size_t kNever = std::numeric_limits<std::size_t>::max();

void pause_briefly() {
#if defined(__x86_64__) || defined(__i386__)
  _mm_pause();
#endif
}

/// The pieces not yet taken, [front, back), and the number of the frame they belong to: in one word, so that a helper
/// that slept through a frame cannot take a piece of the wrong one.
struct Ticket {
  std::uint32_t frame = 0;
  std::uint16_t front = 0;
  std::uint16_t back = 0;

  std::uint64_t word() const { return std::uint64_t{frame} << 32 | std::uint64_t{front} << 16 | back; }
  static Ticket of(std::uint64_t word) {
    return {static_cast<std::uint32_t>(word >> 32), static_cast<std::uint16_t>(word >> 16),
            static_cast<std::uint16_t>(word)};
  }
};

}  // namespace

struct FrameThreads::Crew {
  // The frame at work. Written by the caller before it issues the ticket; read only by who holds a piece of it.
  detail::PanelMatrix matrix;
  detail::FrameFactors frame;
  detail::FrameTarget target;
  std::size_t piece_panels = 1;

  alignas(64) std::atomic<std::uint64_t> ticket = 0;
  alignas(64) std::atomic<std::uint32_t> done = 0;
  alignas(64) std::atomic<bool> stop = false;
  std::atomic_flag busy;

  std::size_t least_bytes = 0;
  std::uint64_t frames_alone = 0;  // still to go without help
  std::size_t alone_bytes = 0;     // of the model whose frames alone took
  double alone_seconds = 0;        // this long, a running mean; 0: not known
  std::uint32_t frame_number = 0;
  std::vector<std::thread> helpers;

  /// Takes the first or the last piece that is left; false where there is none.
  bool take(bool from_front, std::size_t& piece) noexcept {
    std::uint64_t word = ticket.load(std::memory_order_acquire);
    for (;;) {
      Ticket next = Ticket::of(word);
      if (next.front >= next.back) return false;
      piece = from_front ? next.front++ : --next.back;
      if (ticket.compare_exchange_weak(word, next.word(), std::memory_order_acq_rel, std::memory_order_acquire)) {
        return true;
      }
    }
  }

  void work(bool from_front) noexcept {
    std::size_t piece = 0;
    while (take(from_front, piece)) {
      const std::size_t first = piece * piece_panels;
      detail::panel_product(matrix, first, std::min(first + piece_panels, matrix.panels()), &frame, &target, 1);
      done.fetch_add(1, std::memory_order_release);
    }
  }

  void help() {
    auto last_work = Clock::now();
    int idle = 0;
    while (!stop.load(std::memory_order_relaxed)) {
      const Ticket now = Ticket::of(ticket.load(std::memory_order_acquire));
      if (now.front < now.back) {
        work(false);
        last_work = Clock::now();
        idle = 0;
      } else if (++idle < 1000) {
        pause_briefly();
      } else {
        const bool recent = Clock::now() - last_work < std::chrono::milliseconds(100);
        std::this_thread::sleep_for(std::chrono::microseconds(recent ? 50 : 1000));
      }
    }
  }

  void run_together() noexcept {
    const auto begin = Clock::now();
    constexpr std::size_t kMostPieces = 0xffff;
    const std::size_t panels = matrix.panels();
    piece_panels = std::max(piece_panels, (panels + kMostPieces - 1) / kMostPieces);
    const std::size_t pieces = (panels + piece_panels - 1) / piece_panels;
    done.store(0, std::memory_order_relaxed);
    ticket.store(Ticket{++frame_number, 0, static_cast<std::uint16_t>(pieces)}.word(), std::memory_order_release);
    work(true);
    const auto own_end = Clock::now();
    while (done.load(std::memory_order_acquire) != pieces) pause_briefly();
    const auto end = Clock::now();
    const double waited = std::chrono::duration<double>(end - own_end).count();
    const double together = std::chrono::duration<double>(end - begin).count();
    // Late, or on the caller's own core, which shows only beside frames alone.
    double lost = waited > kLateSeconds ? waited : 0;
    if (alone_seconds > 0) lost = std::max(lost, together - alone_seconds);
    const double usual = alone_seconds > 0 ? alone_seconds : together - waited;
    frames_alone = static_cast<std::uint64_t>(lost / (kLateShare * std::max(usual, 1e-6)));
  }

  void run_alone(const detail::PanelMatrix& whole, std::size_t bytes, const detail::FrameFactors& factors,
                 const detail::FrameTarget& to) noexcept {
    const auto begin = Clock::now();
    detail::panel_product(whole, 0, whole.panels(), &factors, &to, 1);
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    constexpr double kNewShare = 0.2;
    alone_seconds = bytes == alone_bytes ? alone_seconds + kNewShare * (seconds - alone_seconds) : seconds;
    alone_bytes = bytes;
  }
};

FrameThreads::FrameThreads(int threads, std::optional<std::size_t> least_bytes) : crew_(std::make_unique<Crew>()) {
  if (threads < 0) throw Error(ErrorCode::usage, "frame: " + std::to_string(threads) + " threads; 0 means all");
  if (threads == 0) threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  crew_->least_bytes = least_bytes.value_or(kNever);
  for (int i = 1; i < threads; ++i) crew_->helpers.emplace_back([crew = crew_.get()] { crew->help(); });
  if (!least_bytes && threads > 1) measure_least_bytes();
}

/// Models of growing size, each evaluated alone and together in turns, the best time of either: what the machine can
/// do, not what else it was doing just then. Zeros are as fast as any other numbers.
void FrameThreads::measure_least_bytes() {
  constexpr std::size_t kSmallest = 64 * 1024, kLargest = 4 * 1024 * 1024;
  constexpr std::size_t kEntries = 20;
  constexpr std::size_t kPanelBytes = detail::kRestBytes * (kEntries + 1);
  constexpr int kTurns = 12;
  constexpr double kPays = 0.9;
  const detail::AlignedVector<std::byte> zeros(kLargest);
  std::vector<detail::PanelPlace> places;
  for (std::size_t at = 0; at + kPanelBytes <= kLargest; at += kPanelBytes) places.push_back({at, kEntries});
  std::vector<float> positions(3 * detail::kPanelWidth * places.size());
  const detail::AlignedVector<float> weights(kEntries, 0.0F);
  detail::FrameFactors frame{};
  frame.weights = weights.data();
  for (std::size_t bytes = kSmallest; bytes <= kLargest; bytes *= 2) {
    const detail::PanelMatrix matrix{zeros.data(), places.data(), bytes / kPanelBytes * detail::kPanelWidth, false};
    double best[2] = {1, 1};  // alone, together; seconds
    for (int turn = 0; turn < 2 * kTurns; ++turn) {
      crew_->least_bytes = turn % 2 == 0 ? kNever : 0;
      crew_->frames_alone = 0;
      const auto begin = Clock::now();
      run(matrix, bytes, frame, {positions.data(), 3});
      best[turn % 2] = std::min(best[turn % 2], std::chrono::duration<double>(Clock::now() - begin).count());
    }
    crew_->least_bytes = bytes;
    if (best[1] < kPays * best[0]) return;
  }
}

FrameThreads::~FrameThreads() {
  crew_->stop = true;
  for (std::thread& helper : crew_->helpers) helper.join();
}

std::size_t FrameThreads::least_bytes() const noexcept { return crew_->least_bytes; }

int FrameThreads::count() const noexcept { return static_cast<int>(crew_->helpers.size()) + 1; }

void FrameThreads::run(const detail::PanelMatrix& matrix, std::size_t bytes, const detail::FrameFactors& frame,
                       const detail::FrameTarget& target) noexcept {
  Crew& crew = *crew_;
  const bool owner =
      bytes >= crew.least_bytes && !crew.helpers.empty() && !crew.busy.test_and_set(std::memory_order_acquire);
  if (!owner) {
    detail::panel_product(matrix, 0, matrix.panels(), &frame, &target, 1);
    return;
  }
  const bool compare = bytes != crew.alone_bytes || crew.frame_number % kFramesToCompare == 0;
  if (crew.frames_alone > 0 || compare) {
    crew.run_alone(matrix, bytes, frame, target);
    crew.frames_alone -= crew.frames_alone > 0;
    ++crew.frame_number;
  } else {
    crew.matrix = matrix;
    crew.frame = frame;
    crew.target = target;
    crew.piece_panels = std::max<std::size_t>(1, kPieceBytes * matrix.panels() / bytes);
    crew.run_together();
  }
  crew.busy.clear(std::memory_order_release);
}

}  // namespace skinbem
