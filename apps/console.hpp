// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What goes to the terminal beside results: messages and progress, on stderr.
#pragma once

#include <chrono>
#include <filesystem>
#include <string>

#include <skinbem/base/progress.hpp>

/// Prints `skinbem: warning: message`.
void warn(const std::string& message);

/// A line that shows how far the work is, where stderr is a terminal; nothing elsewhere. At most ten times a second.
skinbem::Progress terminal_progress();
/// Wipes that line.
void end_progress();

/// Throws Error(io) when `output` cannot be created, before hours are spent on what it should hold.
void require_writable(const std::filesystem::path& output);

class Stopwatch {
 public:
  double seconds() const { return std::chrono::duration<double>(Clock::now() - start_).count(); }

 private:
  using Clock = std::chrono::steady_clock;
  Clock::time_point start_ = Clock::now();
};
