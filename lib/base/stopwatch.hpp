// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Wall clock time of stages.
#pragma once

#include <chrono>

namespace skinbem {

class Stopwatch {
 public:
  /// Seconds since the last lap, or since construction.
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }
  /// The same, and begins the next lap.
  double lap() {
    const double elapsed = seconds();
    start_ = Clock::now();
    return elapsed;
  }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};

}  // namespace skinbem
