// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/frame/reading_order.hpp>

#include <algorithm>
#include <chrono>
#include <vector>

#include <skinbem/frame/frame_factors.hpp>

namespace skinbem::detail {

bool faster_in_turns(PanelMatrix matrix, std::size_t bytes, std::size_t weights) {
  if (bytes < kLeastBytesInTurns) return false;
  using Clock = std::chrono::steady_clock;
  constexpr int kRounds = 3;
  const AlignedVector<float> zeros = make_weights(weights);  // as fast as any other numbers
  FrameFactors frame{};
  frame.weights = zeros.data();
  std::vector<float> positions(3 * matrix.vertices);
  const FrameTarget target{positions.data()};
  Clock::duration best[] = {Clock::duration::max(), Clock::duration::max()};  // one after the other, in turns
  for (int round = 0; round < kRounds; ++round) {
    for (const bool in_turns : {false, true}) {
      matrix.in_turns = in_turns;
      const auto begin = Clock::now();
      panel_product(matrix, 0, matrix.panels(), &frame, &target, 1);
      best[in_turns] = std::min(best[in_turns], Clock::now() - begin);
    }
  }
  return best[true] < best[false];
}

}  // namespace skinbem::detail
