// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Wall clock time of stages.
#pragma once

#include <chrono>

namespace skinbem {

class Stopwatch {
 public:
  /// Seconds since the last call, or since construction.
  double lap() {
    const auto now = std::chrono::steady_clock::now();
    const double seconds = std::chrono::duration<double>(now - start_).count();
    start_ = now;
    return seconds;
  }

 private:
  std::chrono::steady_clock::time_point start_ = std::chrono::steady_clock::now();
};

}  // namespace skinbem
