// SPDX-License-Identifier: BSD-3-Clause
#include "console.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include <skinbem/base/error.hpp>

namespace {
bool progress_shown = false;
}

void warn(const std::string& message) {
  end_progress();
  fmt::print(stderr, "skinbem: warning: {}\n", message);
}

skinbem::Progress terminal_progress() {
  if (!isatty(STDERR_FILENO)) return {};
  return [last = -1.0, watch = Stopwatch()](std::string_view stage, double fraction) mutable {
    if (last < 0 || watch.seconds() - last > 0.1) {
      last = watch.seconds();
      fmt::print(stderr, "\r\033[K{} {:3.0f} %", stage, 100 * fraction);
      progress_shown = true;
    }
    return true;
  };
}

void end_progress() {
  if (progress_shown) fmt::print(stderr, "\r\033[K");
  progress_shown = false;
}

void require_writable(const std::filesystem::path& output) {
  namespace fs = std::filesystem;
  const fs::path place = output.has_filename() ? output : output.parent_path();
  const fs::path parent = place.has_parent_path() ? place.parent_path() : fs::path(".");
  if (!fs::is_directory(parent)) {
    throw skinbem::Error(skinbem::ErrorCode::io, output.string() + ": cannot write: there is no folder " +
                                                     parent.string() + ", create it first");
  }
  if (access(parent.c_str(), W_OK | X_OK) != 0) {
    throw skinbem::Error(skinbem::ErrorCode::io,
                         output.string() + ": cannot write: no permission to write in " + parent.string());
  }
}
