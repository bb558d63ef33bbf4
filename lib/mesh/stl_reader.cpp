// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <bit>
#include <cctype>
#include <cmath>
#include <cstring>

#include <skinbem/base/error.hpp>
#include <skinbem/mesh/mesh_formats.hpp>
#include <skinbem/mesh/text_scanner.hpp>
#include <skinbem/mesh/weld.hpp>

namespace skinbem {
namespace {

static_assert(std::endian::native == std::endian::little, "binary STL and PLY are read as little-endian memory");

constexpr std::size_t header_bytes = 84, facet_bytes = 50, normal_bytes = 12;

std::uint32_t announced_facets(std::string_view text) {
  std::uint32_t count = 0;
  std::memcpy(&count, text.data() + 80, sizeof count);
  return count;
}

/// Three corners a triangle, welded.
TriangleMesh mesh_of_corners(const std::vector<double>& coordinates, const std::string& name) {
  if (coordinates.empty()) throw Error(ErrorCode::bad_input, name + ": no facets in it, a closed surface is needed");
  const auto corners = static_cast<Index>(coordinates.size() / 3);
  TriangleMesh mesh;
  mesh.vertices = Eigen::Map<const Points>(coordinates.data(), corners, 3);
  mesh.triangles.resize(corners / 3, 3);
  for (Index i = 0; i < corners; ++i) mesh.triangles(i / 3, i % 3) = static_cast<std::int32_t>(i);
  return welded(mesh);
}

TriangleMesh parse_binary(std::string_view text, const std::string& name) {
  const std::size_t facets = announced_facets(text);
  const std::size_t size = header_bytes + facet_bytes * facets;
  if (size != text.size()) {
    fail_at_byte(name, 80,
                 "binary STL: " + std::to_string(facets) + " facets announced, which take " + std::to_string(size) +
                     " bytes, but the file has " + std::to_string(text.size()) +
                     ": it is truncated or not an STL file");
  }
  std::vector<double> coordinates;
  coordinates.reserve(9 * facets);
  for (std::size_t f = 0; f < facets; ++f) {
    const std::size_t offset = header_bytes + facet_bytes * f + normal_bytes;
    float corners[9];
    std::memcpy(corners, text.data() + offset, sizeof corners);
    for (int i = 0; i < 9; ++i) {
      if (!std::isfinite(corners[i])) {
        fail_at_byte(name, offset + sizeof(float) * static_cast<std::size_t>(i),
                     "facet " + std::to_string(f) + ": a coordinate is not finite, correct or remove it");
      }
      coordinates.push_back(corners[i]);
    }
  }
  return mesh_of_corners(coordinates, name);
}

/// Whether `word`, in small letters, is `keyword`.
bool is(std::string_view word, std::string_view keyword) {
  return std::equal(word.begin(), word.end(), keyword.begin(), keyword.end(),
                    [](char a, char b) { return std::tolower(static_cast<unsigned char>(a)) == b; });
}

void expect(TextScanner& scanner, const char* wanted) {
  const std::string_view word = scanner.word(wanted);
  if (!is(word, wanted)) scanner.fail(in_quotes(word) + " where '" + wanted + "' was expected, correct the file");
}

void next_line(TextScanner& scanner, const char* wanted) {
  if (!scanner.next_line()) {
    scanner.fail(std::string("the file ends where '") + wanted + "' was expected, it is truncated");
  }
}

void expect_line(TextScanner& scanner, std::initializer_list<const char*> words) {
  next_line(scanner, *words.begin());
  for (const char* word : words) expect(scanner, word);
  scanner.end_of_line();
}

/// From `normal` to `endfacet`.
void read_facet(TextScanner& scanner, std::vector<double>& coordinates) {
  expect(scanner, "normal");
  for (int d = 0; d < 3; ++d) scanner.any_number("a normal");
  scanner.end_of_line();
  expect_line(scanner, {"outer", "loop"});
  for (int c = 0; c < 3; ++c) {
    next_line(scanner, "vertex");
    expect(scanner, "vertex");
    for (const char* axis : {"x", "y", "z"}) coordinates.push_back(scanner.number(axis));
    scanner.end_of_line();
  }
  expect_line(scanner, {"endloop"});
  expect_line(scanner, {"endfacet"});
}

/// One or several solids.
TriangleMesh parse_ascii(std::string_view text, const std::string& name) {
  TextScanner scanner(text, name, {});
  std::vector<double> coordinates;
  while (scanner.next_line()) {
    expect(scanner, "solid");
    for (;;) {
      next_line(scanner, "endsolid");
      const std::string_view word = scanner.word("facet");
      if (is(word, "facet")) {
        read_facet(scanner, coordinates);
      } else if (is(word, "endsolid")) {
        break;
      } else {
        scanner.fail(in_quotes(word) + " where 'facet' or 'endsolid' was expected, correct the file");
      }
    }
  }
  return mesh_of_corners(coordinates, name);
}

/// Whether `text` is text, as far as its beginning tells: some writers start binary files with "solid" too.
bool looks_like_text(std::string_view text) {
  const std::string_view head = text.substr(0, 1024);
  return std::none_of(head.begin(), head.end(), [](char c) { return c >= 0 && c < 9; });
}

}  // namespace

TriangleMesh parse_stl(std::string_view text, const std::string& name) {
  const bool exact_size =
      text.size() >= header_bytes && text.size() == header_bytes + facet_bytes * announced_facets(text);
  if (!exact_size && looks_like_text(text)) return parse_ascii(text, name);
  if (text.size() < header_bytes) {
    throw Error(ErrorCode::bad_input,
                name + ": neither a text STL nor the 84 bytes of a binary header, it is truncated");
  }
  return parse_binary(text, name);
}

}  // namespace skinbem
