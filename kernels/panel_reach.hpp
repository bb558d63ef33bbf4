// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// How far the points of a panel are from a triangle, in SIMD (Highway, instruction set chosen at run time).
#pragma once

#include <skinbem/kernels/panel.hpp>

namespace skinbem {

/// Points by their squared distance to a centre.
struct PanelReach {
  PanelMask near;      ///< nearer than the limit
  double closest2[2];  ///< of the points that are not near, by half of the panel; infinity where all are
};

PanelReach panel_reach(const PointPanel& panel, const Eigen::Vector3d& centre, double limit2);

}  // namespace skinbem
