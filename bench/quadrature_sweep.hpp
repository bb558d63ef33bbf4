// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Cases of the accuracy programme's own: distance by shape by position by nu by rule.
#pragma once

#include <filesystem>

namespace skinbem {

/// Writes a CSV file, one row per case and rule; docs/quadrature.md describes the columns. The reference is the closed
/// form in __float128, whose rounding is below 1e-20 in every case. Returns the number of rows. Throws Error(io) when
/// the file cannot be written.
long sweep_quadrature(const std::filesystem::path& path);

}  // namespace skinbem
