// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Progress of long work. The library never prints; it calls back.
#pragma once

#include <functional>
#include <string_view>

#include <skinbem/base/error.hpp>

namespace skinbem {

/// Called from the thread that started the work with the stage's name and the done fraction in [0, 1].
/// Return false to cancel: the work then throws Error(ErrorCode::cancelled). May be empty.
using Progress = std::function<bool(std::string_view stage, double fraction)>;

/// Reports to `progress` if there is one and throws when it asks to stop.
inline void report(const Progress& progress, std::string_view stage, double fraction) {
  if (progress && !progress(stage, fraction)) {
    throw Error(ErrorCode::cancelled, "cancelled during " + std::string(stage));
  }
}

}  // namespace skinbem
