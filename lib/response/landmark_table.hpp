// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The landmarks file: comma-separated values with a header row.
///
/// Columns, in any order: `name`; `vertex` (index of the skin's vertex, from 0) and/or `x`, `y`, `z` (unit of the
/// mesh); optional `radius`, `bone`, `bone_x`, `bone_y`, `bone_z`. `skin_vertex`, `skin_x`, `skin_y`, `skin_z` mean the
/// same as `vertex`, `x`, `y`, `z`. Any other column is an error, since a misspelt one would be lost in silence. A cell
/// of an optional column may be empty. Fields may be quoted ("" inside is a quote); blank lines and lines that begin
/// with # are skipped.
#pragma once

#include <filesystem>
#include <vector>

#include <skinbem/mesh/triangle_mesh.hpp>
#include <skinbem/response/landmark.hpp>

namespace skinbem {

/// How a landmark given by coordinates found its vertex.
struct LandmarkSnap {
  std::string name;
  Vec3 asked;                     ///< the coordinates in the file
  std::int32_t vertex = 0;        ///< the nearest vertex
  double distance = 0;            ///< between the two, unit of the mesh
  bool vertex_overruled = false;  ///< the file named another vertex, which lies elsewhere
};

struct LandmarkTable {
  std::vector<Landmark> landmarks;  ///< in the order of the file; never empty; names differ
  std::vector<LandmarkSnap> snaps;  ///< those given by coordinates more than 1e-6 of the diagonal off their vertex
};

/// Reads `path` for the skin `mesh`. Landmarks without a radius get `default_radius` (>= 0). Where vertex and
/// coordinates disagree by more than 1e-6 of the mesh's diagonal, the coordinates win: the vertex nearest to them is
/// taken, and reported in `snaps`; farther than 5 % of the diagonal is an error. Throws Error(io) when the file cannot
/// be read, Error(bad_input) "path:line: ..." for all that is wrong in it. That the landmarks suffice (three, not on a
/// line, on different vertices) is not asked here but where R is made.
LandmarkTable read_landmarks(const std::filesystem::path& path, const TriangleMesh& mesh, double default_radius);

}  // namespace skinbem
