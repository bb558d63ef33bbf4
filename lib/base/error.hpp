// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The one exception type of the library. Offline code throws it; frame code is noexcept.
#pragma once

#include <stdexcept>
#include <string>

namespace skinbem {

/// What went wrong, by who can mend it. The values are the exit codes of the `skinbem` program.
enum class ErrorCode {
  usage = 2,      ///< the call itself is wrong: an option, a shape, a value out of its documented range
  bad_input = 3,  ///< a file or a mesh is not what it should be
  numerical = 4,  ///< the computation did not reach what was asked (singular system, no convergence)
  io = 5,         ///< a file cannot be read or written
  cancelled = 6,  ///< the caller's progress callback asked to stop
};

/// Message form, where a file is concerned: `file:line: what is wrong, how to mend it`.
class Error : public std::runtime_error {
 public:
  Error(ErrorCode code, const std::string& message) : std::runtime_error(message), code_(code) {}
  ErrorCode code() const noexcept { return code_; }

 private:
  ErrorCode code_;
};

}  // namespace skinbem
