// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Which closed surface of a mesh lies within which.
#pragma once

#include <cstdint>
#include <vector>

#include <skinbem/mesh/triangle_mesh.hpp>

namespace skinbem {

/// Components are told by their first triangle.
struct Nesting {
  std::vector<std::int32_t> inside_out;      ///< outer surfaces that face inward or enclose nothing
  std::vector<std::int32_t> further_bodies;  ///< what is neither the first outer surface nor a cavity of it
  Index cavities = 0;                        ///< surfaces within an outer one, facing the other way
};

/// Every component must be closed and consistently oriented. `component` is of #T: the component of each triangle, -1
/// for none. A component is within another when its first vertex is.
Nesting nesting_of_components(const TriangleMesh& mesh, const std::vector<std::int32_t>& component,
                              std::int32_t component_count);

}  // namespace skinbem
