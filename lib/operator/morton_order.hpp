// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Points in an order in which neighbours are close.
#pragma once

#include <cstdint>
#include <vector>

#include <Eigen/Core>

namespace skinbem::detail {

/// Indices of the points along Morton's curve: neighbours in it are neighbours in space, so a panel's points are close.
std::vector<std::int32_t> morton_order(const std::vector<Eigen::Vector3d>& points);

}  // namespace skinbem::detail
