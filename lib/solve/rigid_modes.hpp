// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Rigid motions as vectors of the discrete system.
#pragma once

#include <skinbem/base/types.hpp>

namespace skinbem {

/// B, 3N by 6 with orthonormal columns: the three translations and three linearised rotations about the centroid of the
/// points (node-major). The null space of H. Throws Error(bad_input) where the points lie on a line and a rotation is
/// lost.
Eigen::MatrixXd rigid_modes(const Points& points);

}  // namespace skinbem
