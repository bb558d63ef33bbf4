// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/frame/frame_threads.hpp>

#include <algorithm>
#include <array>
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

/// A piece is about this many bytes, some microseconds, so that the wait at the end is short; in memory that no cache
/// holds, where each begins slowly, as many as make it a small share.
constexpr std::size_t kPieceBytes = 64 * 1024, kMostPieces = 128;
/// Share of the time that help may cost where it costs more than it gained before; half of it after every loss, down to
/// the least. It is tried again after this time, in seconds, at the latest.
constexpr double kLostShare = 0.1, kLeastLostShare = 0.01, kLongestAlone = 0.1;
/// What was gained counts up to this many frames, so that helpers that begin to cost are soon left alone.
constexpr double kMostGained = 10;
/// The first frames of a model, and one in so many later on, are evaluated alone, to know what help gains.
constexpr std::uint32_t kFramesToKnow = 4;
constexpr std::uint32_t kFramesToCompare = 512;
/// A helper looks for the next frame all the time at first, then at intervals of a share of the time without one: to
/// wake costs, on a busy machine the caller too.
constexpr std::chrono::microseconds kSpinning{100}, kShortestNap{50}, kLongestNap{1000};
constexpr int kNapShare = 4;
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

/// How long frames of a model take without help.
struct FramesAlone {
  std::size_t bytes = 0;  // of the model; two of the same size are taken for one
  std::uint32_t frames = 0;
  double seconds = 0;

  /// The shortest time counts at once, longer ones by and by: what the machine does besides is no gain of help.
  void add(double measured) {
    constexpr double kNewShare = 0.2;
    seconds = frames == 0 || measured < seconds ? measured : seconds + kNewShare * (measured - seconds);
    ++frames;
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
  double gained = 0;               // seconds, by help
  double lost_share = kLostShare;
  std::array<FramesAlone, 8> alone;
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
    while (!stop.load(std::memory_order_relaxed)) {
      const Ticket now = Ticket::of(ticket.load(std::memory_order_acquire));
      if (now.front < now.back) {
        work(false);
        last_work = Clock::now();
        continue;
      }
      const auto idle = std::chrono::duration_cast<std::chrono::microseconds>(Clock::now() - last_work);
      if (idle < kSpinning) {
        pause_briefly();
      } else {
        std::this_thread::sleep_for(std::clamp(idle / kNapShare, kShortestNap, kLongestNap));
      }
    }
  }

  /// All panels of a frame, with or without the helpers.
  void run(bool together, const detail::PanelMatrix& whole, std::size_t bytes, const detail::FrameFactors& factors,
           const detail::FrameTarget& to) noexcept {
    ++frame_number;
    if (!together) {
      detail::panel_product(whole, 0, whole.panels(), &factors, &to, 1);
      return;
    }
    matrix = whole;
    frame = factors;
    target = to;
    const std::size_t panels = whole.panels();
    const std::size_t least = whole.in_turns ? detail::kPanelsInTurns : 1;
    piece_panels = std::max({least, kPieceBytes * panels / bytes, panels / kMostPieces}) / least * least;
    const std::size_t pieces = (panels + piece_panels - 1) / piece_panels;
    done.store(0, std::memory_order_relaxed);
    ticket.store(Ticket{frame_number, 0, static_cast<std::uint16_t>(pieces)}.word(), std::memory_order_release);
    work(true);
    while (done.load(std::memory_order_acquire) != pieces) pause_briefly();
  }

  FramesAlone& alone_of(std::size_t bytes) noexcept {
    FramesAlone& found = alone[bytes / 64 % alone.size()];
    if (found.bytes != bytes) found = {bytes};
    return found;
  }

  /// Help is asked for as long as it gains, seen over the last frames: helpers that are late now and then cost nothing
  /// more; those that are late again and again, or on the caller's own core, are left alone until what they cost is a
  /// small share.
  void run_watched(const detail::PanelMatrix& whole, std::size_t bytes, const detail::FrameFactors& factors,
                   const detail::FrameTarget& to) noexcept {
    FramesAlone& usual = alone_of(bytes);
    const bool together = frames_alone == 0 && usual.frames >= kFramesToKnow && frame_number % kFramesToCompare != 0;
    const auto begin = Clock::now();
    run(together, whole, bytes, factors, to);
    const double seconds = std::chrono::duration<double>(Clock::now() - begin).count();
    if (!together) {
      usual.add(seconds);
      frames_alone -= frames_alone > 0;
      return;
    }
    const double most_gained = kMostGained * usual.seconds;
    gained = std::min(gained + usual.seconds - seconds, most_gained);
    if (gained == most_gained) lost_share = kLostShare;
    if (gained >= 0) return;
    const double apart = std::min(-gained / lost_share, kLongestAlone);
    frames_alone = static_cast<std::uint64_t>(apart / std::max(usual.seconds, 1e-6));
    gained = 0;
    lost_share = std::max(lost_share / 2, kLeastLostShare);
  }
};

FrameThreads::FrameThreads(int threads, std::optional<std::size_t> least_bytes) : crew_(std::make_unique<Crew>()) {
  if (threads < 0) throw Error(ErrorCode::usage, "frame: " + std::to_string(threads) + " threads; 0 means all");
  if (threads == 0) threads = std::max(1, static_cast<int>(std::thread::hardware_concurrency()));
  crew_->least_bytes = least_bytes.value_or(kNever);
  for (int i = 1; i < threads; ++i) crew_->helpers.emplace_back([crew = crew_.get()] { crew->help(); });
  if (!least_bytes && threads > 1) measure_least_bytes();
}

/// Models of several sizes, each evaluated together and alone in turns, the best time of either: what the machine can
/// do, not what else it was doing just then. Turns in which not even the largest gains do not count: something else had
/// the helpers' cores. Zeros are as fast as any other numbers.
void FrameThreads::measure_least_bytes() {
  constexpr std::size_t kSmallest = 64 * 1024, kSizes = 7;
  constexpr std::size_t kEntries = 20;
  constexpr std::size_t kPanelBytes = detail::kRestBytes * (kEntries + 1);
  constexpr int kTurns = 4, kMostTurns = 20;
  constexpr std::chrono::microseconds kTurn{60}, kToWake{200};
  constexpr double kPays = 0.9;
  constexpr std::size_t kUnknown = 1024 * 1024;
  const detail::AlignedVector<std::byte> zeros(kSmallest << (kSizes - 1));
  std::vector<detail::PanelPlace> places;
  for (std::size_t at = 0; at + kPanelBytes <= zeros.size(); at += kPanelBytes) places.push_back({at, kEntries});
  std::vector<float> positions(3 * detail::kPanelWidth * places.size());
  const detail::AlignedVector<float> weights(kEntries, 0.0F);
  detail::FrameFactors frame{};
  frame.weights = weights.data();
  double best[kSizes][2];  // alone, together; seconds
  std::fill_n(&best[0][0], 2 * kSizes, 1.0);
  const auto turn = [&](std::size_t size, bool together, std::chrono::microseconds at_least) {
    const std::size_t bytes = kSmallest << size;
    const detail::PanelMatrix matrix{zeros.data(), places.data(), bytes / kPanelBytes * detail::kPanelWidth, false};
    double shortest = 1;
    const auto start = Clock::now();
    for (auto begin = start; begin - start < at_least;) {
      crew_->run(together, matrix, bytes, frame, {positions.data(), 3});
      const auto end = Clock::now();
      shortest = std::min(shortest, std::chrono::duration<double>(end - begin).count());
      begin = end;
    }
    best[size][together] = std::min(best[size][together], shortest);
    return shortest;
  };
  int good = 0;
  for (int i = 0; i < kMostTurns && good < kTurns; ++i) {
    double shortest[2] = {};  // of the largest
    turn(kSizes - 1, true, kToWake);
    for (const bool together : {true, false}) {
      for (std::size_t size = 0; size < kSizes; ++size) shortest[together] = turn(size, together, kTurn);
    }
    good += shortest[true] < kPays * shortest[false];
  }
  const auto pays = [&](std::size_t size) { return best[size][true] < kPays * best[size][false]; };
  std::size_t least = 0;
  while (least < kSizes - 1 && !pays(least)) ++least;
  crew_->least_bytes = good == kTurns ? kSmallest << least : kUnknown;
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
  crew.run_watched(matrix, bytes, frame, target);
  crew.busy.clear(std::memory_order_release);
}

}  // namespace skinbem
