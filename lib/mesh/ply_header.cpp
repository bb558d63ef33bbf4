// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/mesh/ply_header.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>
#include <optional>

#include <skinbem/mesh/text_scanner.hpp>

namespace skinbem::ply {
namespace {

Type read_type(TextScanner& scanner) {
  struct Name {
    std::string_view word;
    Type type;
  };
  constexpr std::array<Name, 16> names{{{"char", Type::int8},
                                        {"int8", Type::int8},
                                        {"uchar", Type::uint8},
                                        {"uint8", Type::uint8},
                                        {"short", Type::int16},
                                        {"int16", Type::int16},
                                        {"ushort", Type::uint16},
                                        {"uint16", Type::uint16},
                                        {"int", Type::int32},
                                        {"int32", Type::int32},
                                        {"uint", Type::uint32},
                                        {"uint32", Type::uint32},
                                        {"float", Type::float32},
                                        {"float32", Type::float32},
                                        {"double", Type::float64},
                                        {"float64", Type::float64}}};
  const std::string_view word = scanner.word("a type");
  const auto found = std::find_if(names.begin(), names.end(), [&](const Name& name) { return name.word == word; });
  if (found == names.end())
    scanner.fail("unknown type " + in_quotes(word) + ", PLY has char to double and int8 to float64");
  return found->type;
}

bool is_floating(Type type) { return type == Type::float32 || type == Type::float64; }

Encoding read_format(TextScanner& scanner) {
  const std::string_view format = scanner.word("a format");
  const std::string_view version = scanner.word("a version");
  if (version != "1.0") scanner.fail("PLY version " + in_quotes(version) + ", only 1.0 is known");
  if (format == "ascii") return Encoding::ascii;
  if (format == "binary_little_endian") return Encoding::little_endian;
  if (format == "binary_big_endian") return Encoding::big_endian;
  scanner.fail("unknown format " + in_quotes(format) +
               ", ascii, binary_little_endian or binary_big_endian was expected");
}

Element read_element(TextScanner& scanner, const std::vector<Element>& before) {
  Element element;
  element.name = scanner.word("the name of an element");
  element.count = scanner.integer("the number of elements");
  if (element.count < 0) scanner.fail("a negative number of elements, correct it");
  if (std::any_of(before.begin(), before.end(), [&](const Element& e) { return e.name == element.name; })) {
    scanner.fail("element " + in_quotes(element.name) + " is declared twice, remove one");
  }
  return element;
}

Property read_property(TextScanner& scanner, const Element& element) {
  Property property;
  TextScanner lookahead = scanner;
  if (lookahead.word("a type") == "list") {
    scanner = lookahead;
    property.is_list = true;
    property.count_type = read_type(scanner);
    if (is_floating(property.count_type)) scanner.fail("the length of a list cannot be a floating type, correct it");
  }
  property.type = read_type(scanner);
  property.name = scanner.word("the name of a property");
  const auto& others = element.properties;
  if (std::any_of(others.begin(), others.end(), [&](const Property& p) { return p.name == property.name; })) {
    scanner.fail("property " + in_quotes(property.name) + " is declared twice, remove one");
  }
  return property;
}

void require_mesh(const Header& header, const TextScanner& scanner) {
  const auto find = [&](std::string_view name) {
    return std::find_if(header.elements.begin(), header.elements.end(),
                        [&](const Element& e) { return e.name == name; });
  };
  for (const Element& element : header.elements) {  // one without bytes could be announced any number of times
    if (element.properties.empty())
      scanner.fail("element " + in_quotes(element.name) + " has no properties, remove it");
  }
  const auto vertex = find("vertex"), face = find("face");
  if (vertex == header.elements.end()) scanner.fail("no element 'vertex' in the header, a mesh was expected");
  std::size_t axes = 0;
  for (const Property& p : vertex->properties) axes += !p.is_list && axis_of(p.name) != std::string_view::npos;
  if (axes != 3) scanner.fail("element 'vertex' needs the properties x, y and z");
  if (face == header.elements.end())
    scanner.fail("no element 'face' in the header, a surface is needed (not a point cloud)");
  if (std::count_if(face->properties.begin(), face->properties.end(), is_corner_list) != 1) {
    scanner.fail("element 'face' needs one list 'vertex_indices' (or 'vertex_index') of a whole-number type");
  }
}

}  // namespace

Header parse_header(std::string_view text, const std::string& name) {
  constexpr std::string_view last = "end_header";
  if (!text.empty() && !text.starts_with("ply") && !text.starts_with("\xEF\xBB\xBFply")) {
    fail_at_line(name, 1, "does not start with 'ply', check the file and its extension");
  }
  const auto end = text.find(last);
  if (!text.empty() && end == text.npos)
    fail_at_line(name, 1, "no 'end_header' in it, it is truncated or not a PLY file");
  const std::string_view head = text.substr(0, text.empty() ? 0 : end + last.size());
  TextScanner scanner(head, name, {});
  Header header;
  std::optional<Encoding> encoding;
  while (scanner.next_line()) {
    const std::string_view keyword = scanner.word("a keyword");
    if (keyword == "comment" || keyword == "obj_info") continue;
    if (keyword == "format") {
      encoding = read_format(scanner);
    } else if (keyword == "element") {
      header.elements.push_back(read_element(scanner, header.elements));
    } else if (keyword == "property" && !header.elements.empty()) {
      header.elements.back().properties.push_back(read_property(scanner, header.elements.back()));
    } else if (keyword != last && !(keyword == "ply" && scanner.line() == 1)) {
      scanner.fail("unexpected " + in_quotes(keyword) + " in the header, correct it");
    }
    scanner.end_of_line();
  }
  if (!encoding) scanner.fail("no 'format' in the header, add it");
  require_mesh(header, scanner);
  header.encoding = *encoding;
  header.body_offset = head.size();
  if (text.substr(header.body_offset).starts_with("\r\n")) {
    header.body_offset += 2;
  } else if (header.body_offset < text.size()) {
    if (text[header.body_offset] != '\n' && text[header.body_offset] != '\r') {
      scanner.fail("'end_header' must stand alone on its line, correct it");
    }
    header.body_offset += 1;
  }
  header.body_line = scanner.line() + 1;
  return header;
}

std::size_t size_of(Type type) {
  constexpr std::array<std::size_t, 8> sizes{1, 1, 2, 2, 4, 4, 4, 8};
  return sizes[static_cast<std::size_t>(type)];
}

double value_of(const char* bytes, Type type) {
  const auto as = [&](auto value) {
    std::memcpy(&value, bytes, sizeof value);
    return static_cast<double>(value);
  };
  switch (type) {
    case Type::int8:
      return as(std::int8_t{});
    case Type::uint8:
      return as(std::uint8_t{});
    case Type::int16:
      return as(std::int16_t{});
    case Type::uint16:
      return as(std::uint16_t{});
    case Type::int32:
      return as(std::int32_t{});
    case Type::uint32:
      return as(std::uint32_t{});
    case Type::float32:
      return as(float{});
    case Type::float64:
      break;
  }
  return as(double{});
}

bool fits(double value, Type type) {
  if (is_floating(type)) return true;
  const int bits = 8 * static_cast<int>(size_of(type));
  const bool is_signed = type == Type::int8 || type == Type::int16 || type == Type::int32;
  const double upper = std::ldexp(1.0, is_signed ? bits - 1 : bits);
  return std::trunc(value) == value && value < upper && value >= (is_signed ? -upper : 0);
}

std::size_t axis_of(std::string_view property_name) {
  return property_name.size() == 1 ? std::string_view("xyz").find(property_name) : std::string_view::npos;
}

bool is_corner_list(const Property& property) {
  return property.is_list && !is_floating(property.type) &&
         (property.name == "vertex_indices" || property.name == "vertex_index");
}

}  // namespace skinbem::ply
