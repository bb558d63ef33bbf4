// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/mesh/mesh_formats.hpp>
#include <skinbem/mesh/polygon_soup.hpp>
#include <skinbem/mesh/text_scanner.hpp>

namespace skinbem {
namespace {

struct Counts {
  std::int64_t vertices = 0, faces = 0;
};

/// `[ST][C][N]OFF`, then the counts on the same line or the next.
Counts read_header(TextScanner& scanner) {
  if (!scanner.next_line()) scanner.fail("only comments in it, OFF was expected");
  const std::string_view keyword = scanner.word("OFF");
  std::string_view prefix = keyword;
  if (!prefix.ends_with("OFF")) scanner.fail("starts with " + in_quotes(keyword) + ", the word OFF was expected first");
  prefix.remove_suffix(3);
  for (const std::string_view known : {"ST", "C", "N"}) {
    if (prefix.starts_with(known)) prefix.remove_prefix(known.size());
  }
  if (!prefix.empty()) scanner.fail(in_quotes(keyword) + " has other than three dimensions, save it as plain OFF");
  if (!scanner.more() && !scanner.next_line())
    scanner.fail("ends before the counts, number of vertices and faces expected");
  Counts counts;
  const std::string_view first = scanner.word("the number of vertices");
  if (!parse_integer(first, counts.vertices))
    scanner.fail(in_quotes(first) + " is not a number of vertices, correct it");
  counts.faces = scanner.integer("the number of faces");
  if (scanner.more()) scanner.integer("the number of edges");
  scanner.end_of_line();
  if (counts.vertices < 0 || counts.faces < 0) scanner.fail("a count is negative, correct it");
  return counts;
}

void next_element(TextScanner& scanner, const char* what, std::int64_t done, std::int64_t all) {
  if (scanner.next_line()) return;
  scanner.fail("the file ends after " + std::to_string(done) + " of the " + std::to_string(all) + " " + what +
               " announced, it is truncated or its counts are wrong");
}

}  // namespace

TriangleMesh parse_off(std::string_view text, const std::string& name) {
  if (text.substr(0, text.find('\n')).find("BINARY") != text.npos) fail_at_line(name, 1, "binary OFF, save it as text");
  TextScanner scanner(text, name, {.comment = '#'});
  const Counts counts = read_header(scanner);
  PolygonSoup soup{.name = name};
  for (std::int64_t i = 0; i < counts.vertices; ++i) {
    next_element(scanner, "vertices", i, counts.vertices);
    const double x = scanner.number("x"), y = scanner.number("y"), z = scanner.number("z");
    soup.add_vertex(x, y, z);
    while (scanner.more()) scanner.any_number("a normal, colour or texture coordinate");
  }
  for (std::int64_t i = 0; i < counts.faces; ++i) {
    next_element(scanner, "faces", i, counts.faces);
    const std::int64_t corner_count = scanner.integer("the number of corners");
    for (std::int64_t c = 0; c < corner_count; ++c) soup.corners.push_back(scanner.integer("a vertex index"));
    soup.end_face(scanner.line());
    while (scanner.more()) scanner.any_number("a colour");
  }
  if (scanner.next_line()) {
    scanner.fail("more lines than the " + std::to_string(counts.vertices) + " vertices and " +
                 std::to_string(counts.faces) + " faces announced, correct the counts or remove them");
  }
  return triangulated(soup);
}

}  // namespace skinbem
