// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Vertices at exactly equal positions.
#pragma once

#include <cstdint>
#include <vector>

#include <skinbem/mesh/triangle_mesh.hpp>

namespace skinbem {

/// #P: the lowest index of a point with the same coordinates (0 and -0 are the same): i itself where it is the first.
/// Linear in the number of points.
std::vector<std::int32_t> first_equal_point(const Points& points);

/// The mesh with equal vertices made one, in the order of first appearance. No triangle is dropped: one that collapses
/// has a repeated index then, which the validation reports.
TriangleMesh welded(const TriangleMesh& mesh);

}  // namespace skinbem
