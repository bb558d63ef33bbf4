// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Every tolerance of the tests, each with its reason. Relative to the largest entry of what is compared, unless said.
#pragma once

namespace skinbem::tolerance {

/// A short chain of additions and products in double.
inline constexpr double rounding = 1e-14;

}  // namespace skinbem::tolerance
