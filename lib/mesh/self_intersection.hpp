// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Where a surface meets itself other than along its edges.
#pragma once

#include <array>
#include <cstdint>
#include <vector>

#include <skinbem/mesh/triangle_mesh.hpp>

namespace skinbem {

/// Pairs of triangles, the lower index first, in ascending order, that share a point beside their common corners:
/// crossing, touching, overlapping in one plane, or folded onto each other at their common edge. Corners at equal
/// positions count as common; pairs with three common corners (duplicates) are not listed.
/// `triangles` are those examined: none may be degenerate. Stops at `most` pairs.
/// Signs are decided by predicates.hpp, so neighbours in nearly one plane are told apart reliably.
std::vector<std::array<std::int32_t, 2>> self_intersections(const TriangleMesh& mesh,
                                                            std::vector<std::int32_t> triangles, std::size_t most);

}  // namespace skinbem
