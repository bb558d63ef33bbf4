// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Meshes from and to files: OBJ, OFF, STL, PLY, chosen by the extension (.obj .off .stl .ply in any case).
#pragma once

#include <filesystem>

#include <skinbem/mesh/triangle_mesh.hpp>

namespace skinbem {

struct ReadOptions {
  /// Makes vertices at exactly equal positions one, in the order of first appearance. STL is always welded.
  bool weld = false;
};

/// Reads strictly: what is not understood is refused, not skipped, with the place: Error(bad_input),
/// `file:line: what is wrong, how to mend it`, or the byte for binary files. Vertex order is that of the file; polygons
/// are split into triangles (polygon_soup.hpp says how). Coordinates are finite and indices valid afterwards; whether
/// the mesh bounds a body is another question (validate.hpp). Throws Error(usage) for an unknown extension, Error(io)
/// when the file cannot be read.
TriangleMesh read_mesh(const std::filesystem::path& path, const ReadOptions& options = {});

/// Writes the whole file or nothing. Reading it back gives the same mesh, bit by bit, from OBJ, OFF and PLY (binary
/// double); STL holds floats and no vertex order, so positions come back rounded. Throws Error(usage) for an unknown
/// extension, Error(bad_input) for coordinates that are not finite or do not fit into the format, Error(io) when the
/// file cannot be written.
void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh);

}  // namespace skinbem
