// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Finer meshes of one smooth body, so that a response can be compared across resolutions vertex by vertex.
#pragma once

#include <vector>

#include <skinbem/mesh/triangle_mesh.hpp>

namespace skinbem::bench {

/// Meshes 0 to `times` of the smooth surface through the vertices of `skin`: its limit surface of C. Loop's subdivision
/// (Smooth Subdivision Surfaces Based on Triangles, 1987), whose control net is found so that the limit passes through
/// the vertices. Mesh 0 is the skin; each following has four times the triangles and the vertices of the one before it
/// first, in the same places. `skin` must be closed. Throws Error(numerical) where no control net is found.
std::vector<TriangleMesh> smooth_refinements(const TriangleMesh& skin, int times);

}  // namespace skinbem::bench
