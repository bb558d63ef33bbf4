// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A table of element integrals: reading it, and the error of a result against it.
#pragma once

#include <Eigen/Core>
#include <array>
#include <filesystem>
#include <string>
#include <vector>

namespace skinbem {

/// The integrals of Kelvin's U and T (mu = 1) over one triangle against its three hat functions: 3 x 3 blocks, row =
/// load direction at x, column = component at y.
struct ElementBlocks {
  std::array<Eigen::Matrix3d, 3> U, T;
};

/// One row of the table; the columns are described in tests/reference/README.md.
struct QuadratureCase {
  std::size_t line = 0;   ///< in its file
  std::string id, group;  ///< group: the column `class`
  double poisson = 0;
  std::array<Eigen::Vector3d, 3> vertices;
  Eigen::Vector3d x;
  ElementBlocks exact;
  std::array<bool, 3> has_T;                ///< false where the integral does not exist (blank cells)
  double condition_U = 0, condition_T = 0;  ///< change of the result when v - x is rounded to double
};

/// Reads the whole table. Columns are found by name; unknown ones are ignored. Throws Error(io) when the file cannot be
/// read and Error(bad_input) with `file:line: ...` for a missing column, a row of another length, a cell that is not a
/// finite number, a partly blank block, a Poisson ratio outside (-1, 1/2], or a table without rows.
std::vector<QuadratureCase> read_quadrature_cases(const std::filesystem::path& path);

/// The largest error of an entry over the largest exact entry of its 3 x 3 block, the worst of the three blocks. NaN
/// anywhere gives infinity; a block that is exactly zero (T in the plane at nu = 1/2) counts by its absolute error.
double error_of_U(const QuadratureCase& c, const ElementBlocks& result);
/// The same for those blocks of T that exist; 0 when none does.
double error_of_T(const QuadratureCase& c, const ElementBlocks& result);

/// The longest edge of the triangle.
double longest_edge(const QuadratureCase& c);

}  // namespace skinbem
