// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The few types that every floor shares. Lengths are in the unit of the mesh (millimetres in all we ship), time in
/// seconds.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace skinbem {

using Index = Eigen::Index;
using Vec3 = Eigen::Vector3d;
using Mat3 = Eigen::Matrix3d;
/// #P by 3, row-major: x, y, z of a point are adjacent, so data() is the node-major vector of the boundary element
/// system.
using Points = Eigen::Matrix<double, Eigen::Dynamic, 3, Eigen::RowMajor>;
/// #T by 3 vertex indices, counter-clockwise seen from outside the body.
using Triangles = Eigen::Matrix<std::int32_t, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// Dense matrix stored row by row.
using RowMajorMatrix = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;

/// Some long vectors side by side, stored row by row: an operator is applied to all of them at once.
using VectorBlock = RowMajorMatrix;

/// A proper rigid motion x -> rotation x + translation.
struct RigidMotion {
  Mat3 rotation = Mat3::Identity();
  Vec3 translation = Vec3::Zero();

  Vec3 operator()(const Vec3& x) const { return rotation * x + translation; }
  /// The motion that applies `b` first.
  friend RigidMotion operator*(const RigidMotion& a, const RigidMotion& b) {
    return {a.rotation * b.rotation, a.rotation * b.translation + a.translation};
  }
  RigidMotion inverse() const { return {rotation.transpose(), -(rotation.transpose() * translation)}; }
};

}  // namespace skinbem
