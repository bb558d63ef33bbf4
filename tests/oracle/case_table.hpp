// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The project's own table of element integrals: its cases, and how it is written and compared.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include "element_oracle.hpp"

namespace skinbem::oracle {

/// The input of one row; coordinates are exact doubles.
struct Case {
  std::string id, group, shape, orient, scale, position, ratio;
  double nu = 0;
  std::array<Eigen::Vector3d, 3> corners;
  Eigen::Vector3d x;
};

/// All cases, the same on every machine.
std::vector<Case> make_cases();

/// Integrates every case and writes the table; the columns are described in tests/reference/README.md.
void write_case_table(const std::filesystem::path& path);

/// Integrates every case of a table again and prints the worst differences, relative to the largest entry of a block.
void compare_case_table(const std::filesystem::path& path);

}  // namespace skinbem::oracle
