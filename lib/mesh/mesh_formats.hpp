// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The readers and writers behind mesh_io.hpp, one pair a format. `text` is the whole file, `name` is what messages
/// call it; readers throw Error(bad_input) with the place.
#pragma once

#include <ostream>
#include <string>
#include <string_view>

#include <skinbem/mesh/triangle_mesh.hpp>

namespace skinbem {

/// Wavefront OBJ. Takes v (a weight or a colour behind the coordinates is dropped) and f in all forms; texture,
/// normals, groups, materials, points and lines are skipped; free-form geometry is refused.
TriangleMesh parse_obj(std::string_view text, const std::string& name);
/// Object File Format, text; colours, normals and texture coordinates are dropped.
TriangleMesh parse_off(std::string_view text, const std::string& name);
/// STL, text or binary, told apart by size and content. Normals are ignored; equal points become one vertex, in the
/// order of first appearance.
TriangleMesh parse_stl(std::string_view text, const std::string& name);
/// PLY 1.0: ascii, binary_little_endian or binary_big_endian. Other elements and properties are skipped.
TriangleMesh parse_ply(std::string_view text, const std::string& name);

void write_obj(std::ostream& out, const TriangleMesh& mesh);
void write_off(std::ostream& out, const TriangleMesh& mesh);
/// Binary. Throws Error(bad_input) when a coordinate does not fit into a float.
void write_stl(std::ostream& out, const TriangleMesh& mesh);
/// Binary little-endian, coordinates in double.
void write_ply(std::ostream& out, const TriangleMesh& mesh);

}  // namespace skinbem
