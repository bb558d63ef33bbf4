// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/mesh/mesh_io.hpp>

#include <algorithm>
#include <array>
#include <cctype>

#include <skinbem/base/atomic_file.hpp>
#include <skinbem/base/error.hpp>
#include <skinbem/mesh/mesh_formats.hpp>
#include <skinbem/mesh/weld.hpp>

namespace skinbem {
namespace {

struct Format {
  const char* extension;
  TriangleMesh (*parse)(std::string_view text, const std::string& name);
  void (*write)(std::ostream& out, const TriangleMesh& mesh);
};

constexpr std::array<Format, 4> formats{{{".obj", parse_obj, write_obj},
                                         {".off", parse_off, write_off},
                                         {".stl", parse_stl, write_stl},
                                         {".ply", parse_ply, write_ply}}};

const Format& format_of(const std::filesystem::path& path) {
  std::string extension = path.extension().string();
  for (char& c : extension) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
  const auto found =
      std::find_if(formats.begin(), formats.end(), [&](const Format& f) { return extension == f.extension; });
  if (found != formats.end()) return *found;
  throw Error(ErrorCode::usage,
              path.string() + ": unknown mesh format, use a file name that ends in .obj, .off, .stl or .ply");
}

}  // namespace

TriangleMesh read_mesh(const std::filesystem::path& path, const ReadOptions& options) {
  const Format& format = format_of(path);
  TriangleMesh mesh = format.parse(read_file(path), path.string());
  return options.weld ? welded(mesh) : mesh;
}

void write_mesh(const std::filesystem::path& path, const TriangleMesh& mesh) {
  const Format& format = format_of(path);
  if (!mesh.vertices.allFinite()) {
    throw Error(ErrorCode::bad_input, path.string() + ": a coordinate to be written is not finite");
  }
  write_file_atomically(path, [&](std::ostream& out) { format.write(out, mesh); });
}

}  // namespace skinbem
