// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The long measurement of a frame: percentiles, ratios to Eigen and OpenBLAS and to the bandwidth of the machine, all
/// of one run, taken in turns so that a busy machine disturbs all alike.
#pragma once

#include <filesystem>
#include <optional>

namespace skinbem::bench {

struct ReportOptions {
  bool quick = false;                         ///< fewer cases and frames: under 40 s
  bool busy = false;                          ///< beside a thread that loops: a busy second core
  double seconds = 8;                         ///< at most, for each case, unless quick
  std::optional<std::filesystem::path> json;  ///< one row a case
};

/// Prints a table, and writes it as JSON where asked to.
void frame_report(const ReportOptions& options);

}  // namespace skinbem::bench
