// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Work in a process of its own: its memory can be measured and limited, and its failure does not end the benchmark.
#pragma once

#include <functional>
#include <nlohmann/json.hpp>
#include <string>

namespace skinbem::bench {

struct ChildLimits {
  double bytes = 0;    ///< of address space; 0: none
  double seconds = 0;  ///< of wall time; 0: none
};

struct ChildOutcome {
  nlohmann::json result;     ///< what the work returned; null where it failed
  double peak_bytes = 0;     ///< largest resident memory of the process, the program itself included
  std::string failure = {};  ///< why there is no result; empty where there is one
};

/// Runs `work` in a child process. The caller must not have started OpenMP threads: they do not survive a fork. Throws
/// Error(io) where no process can be made.
ChildOutcome run_in_child(const std::function<nlohmann::json()>& work, const ChildLimits& limits = {});

/// Bytes of memory that the machine can give now.
double available_bytes();

}  // namespace skinbem::bench
