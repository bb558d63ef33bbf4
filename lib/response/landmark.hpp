// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A landmark: a place on the skin that the skeleton moves.
#pragma once

#include <optional>
#include <string>

#include <skinbem/base/types.hpp>

namespace skinbem {

struct Landmark {
  std::string name = {};
  std::int32_t vertex = 0;  ///< index of the mesh vertex at its centre
  /// Of the patch that carries it, unit of the mesh; below the shortest edge at the vertex: a point.
  double radius = 0;
  std::string bone = {};  ///< the bone that carries it; empty where the file names none
  /// The point of that bone nearest to it at rest, mesh coordinates; only `literal` motion needs it.
  std::optional<Vec3> bone_point = {};
};

}  // namespace skinbem
