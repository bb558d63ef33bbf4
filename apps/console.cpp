// SPDX-License-Identifier: BSD-3-Clause
#include "console.hpp"

#include <fmt/format.h>
#include <unistd.h>

#include <cstdio>

#include <skinbem/base/error.hpp>
#include <skinbem/base/stopwatch.hpp>

namespace {
bool progress_shown = false;
}

void warn(const std::string& message) {
  end_progress();
  fmt::print(stderr, "skinbem: warning: {}\n", message);
}

skinbem::Progress terminal_progress() {
  if (!isatty(STDERR_FILENO)) return {};
  return [last = -1.0, watch = skinbem::Stopwatch()](std::string_view stage, double fraction) mutable {
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

void require_name(const std::filesystem::path& output) {
  if (output.empty()) throw skinbem::Error(skinbem::ErrorCode::usage, "the output has no name, give one after -o");
}

void require_writable(const std::filesystem::path& output, const std::vector<std::string>& inputs) {
  namespace fs = std::filesystem;
  using skinbem::Error, skinbem::ErrorCode;
  require_name(output);
  const fs::path place = output.has_filename() ? output : output.parent_path();
  const fs::path parent = place.has_parent_path() ? place.parent_path() : fs::path(".");
  if (!fs::is_directory(parent)) {
    throw Error(ErrorCode::io,
                output.string() + ": cannot write: there is no folder " + parent.string() + ", create it first");
  }
  if (access(parent.c_str(), W_OK | X_OK) != 0) {
    throw Error(ErrorCode::io, output.string() + ": cannot write: no permission to write in " + parent.string());
  }
  if (!fs::exists(place)) return;
  if (!fs::is_regular_file(place) && !fs::is_directory(place)) {
    throw Error(ErrorCode::io, output.string() + ": is no ordinary file, it would be replaced by one: name another");
  }
  for (const std::string& input : inputs) {
    if (fs::exists(input) && fs::equivalent(place, input)) {
      throw Error(ErrorCode::usage, output.string() + ": is the input " + input + ", name another output");
    }
  }
}

void require_writable_file(const std::filesystem::path& output, const std::vector<std::string>& inputs) {
  if (!output.empty() && std::filesystem::is_directory(output)) {
    throw skinbem::Error(skinbem::ErrorCode::io, output.string() + ": is a directory, name a file");
  }
  require_writable(output, inputs);
}
