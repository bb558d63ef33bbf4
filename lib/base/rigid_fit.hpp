// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Best rigid motion between two point sets.
#pragma once

#include <skinbem/base/types.hpp>

namespace skinbem {

/// The proper rotation (det = +1) that maximises trace(Q^T `covariance`): Q = U diag(1, 1, +-1) V^T of its singular
/// value decomposition (Kabsch 1976). Where several are equally good, one of them; any finite input gives a rotation.
Mat3 nearest_rotation(const Mat3& covariance) noexcept;

/// The proper rigid motion (det = +1) that minimises sum |motion(from_i) - to_i|^2; `from` and `to` are #P by 3, #P
/// >= 1. Kabsch (1976), with the sign of the smallest singular direction chosen so that no reflection is returned; no
/// allocation. Where the points leave a rotation free (collinear_measure near 0), one of the minimisers is returned.
RigidMotion fit_rigid(const Eigen::Ref<const Points>& from, const Eigen::Ref<const Points>& to) noexcept;

/// fit_rigid(from, from + displacement) without the sum.
RigidMotion fit_rigid_displacement(const Eigen::Ref<const Points>& from,
                                   const Eigen::Ref<const Points>& displacement) noexcept;

/// Ratio in [0, 1] of the second to the first principal extent of the points: 0 for points on a line.
double collinear_measure(const Eigen::Ref<const Points>& points) noexcept;

}  // namespace skinbem
