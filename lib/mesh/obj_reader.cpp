// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>

#include <skinbem/mesh/mesh_formats.hpp>
#include <skinbem/mesh/polygon_soup.hpp>
#include <skinbem/mesh/text_scanner.hpp>

namespace skinbem {
namespace {

constexpr std::array<std::string_view, 17> skipped{"vt",     "vn",     "vp",    "g",        "o",       "s",
                                                   "usemtl", "mtllib", "l",     "p",        "usemap",  "maplib",
                                                   "mg",     "lod",    "bevel", "c_interp", "d_interp"};

void read_vertex(TextScanner& scanner, PolygonSoup& soup) {
  const double x = scanner.number("x"), y = scanner.number("y"), z = scanner.number("z");
  soup.add_vertex(x, y, z);
  int extra = 0;
  for (; scanner.more(); ++extra) scanner.number("a weight or a colour");
  if (extra != 0 && extra != 1 && extra != 3 && extra != 4) {
    scanner.fail("a vertex of " + std::to_string(3 + extra) + " numbers, x y z with a weight or a colour was expected");
  }
}

/// The vertex index of a corner `v`, `v/vt`, `v/vt/vn` or `v//vn`, 0-based. Negative ones count back from the last
/// vertex so far.
std::int64_t vertex_of_corner(std::string_view corner, const TextScanner& scanner, std::int64_t vertex_count) {
  const auto malformed = [&] {
    scanner.fail(in_quotes(corner) + " is not a corner v, v/vt, v/vt/vn or v//vn, correct it");
  };
  const auto slash = corner.find('/');
  std::int64_t index = 0, ignored = 0;
  if (!parse_integer(corner.substr(0, slash), index)) malformed();
  if (slash != corner.npos) {
    const std::string_view rest = corner.substr(slash + 1);
    const auto second = rest.find('/');
    const std::string_view texture = rest.substr(0, second);
    const bool has_normal = second != rest.npos;
    if (!(texture.empty() && has_normal) && !parse_integer(texture, ignored)) malformed();
    if (has_normal && !parse_integer(rest.substr(second + 1), ignored)) malformed();
  }
  if (index == 0) scanner.fail("face refers to vertex 0, but OBJ counts from 1, correct the index");
  if (index > 0) return index - 1;
  if (index < -vertex_count) {
    scanner.fail("face refers to vertex " + std::to_string(index) + ", but only " + std::to_string(vertex_count) +
                 " vertices stand before it, correct the index");
  }
  return vertex_count + index;
}

}  // namespace

TriangleMesh parse_obj(std::string_view text, const std::string& name) {
  TextScanner scanner(text, name, {.comment = '#', .continuation = true});
  PolygonSoup soup{.name = name, .first_index = 1};
  while (scanner.next_line()) {
    const std::string_view keyword = scanner.word("a keyword");
    if (keyword == "v") {
      read_vertex(scanner, soup);
    } else if (keyword == "f" || keyword == "fo") {
      while (scanner.more())
        soup.corners.push_back(vertex_of_corner(scanner.word("a corner"), scanner, soup.vertex_count()));
      soup.end_face(scanner.line());
    } else if (std::find(skipped.begin(), skipped.end(), keyword) == skipped.end()) {
      scanner.fail("unknown keyword " + in_quotes(keyword) +
                   ", an OBJ file of vertices (v) and faces (f) was expected");
    }
  }
  return triangulated(soup);
}

}  // namespace skinbem
