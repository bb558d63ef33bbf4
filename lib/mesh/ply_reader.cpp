// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <array>
#include <cmath>
#include <cstring>

#include <skinbem/mesh/mesh_formats.hpp>
#include <skinbem/mesh/ply_header.hpp>
#include <skinbem/mesh/polygon_soup.hpp>
#include <skinbem/mesh/text_scanner.hpp>

namespace skinbem {
namespace {

using ply::Element;
using ply::Header;
using ply::Property;
using ply::Type;

/// The values of a text body: one element a line.
class TextValues {
 public:
  TextValues(std::string_view body, const std::string& name, std::int64_t first_line)
      : scanner_(body, name, {.first_line = first_line}) {}

  void begin_element() {
    if (!scanner_.next_line()) fail("the file ends before the announced elements do, it is truncated");
  }
  void end_element() { scanner_.end_of_line(); }
  double read(const Property& property, Type type) {
    const double value = scanner_.any_number(property.name.c_str());
    if (!ply::fits(value, type)) fail("a value of '" + property.name + "' does not fit its type, correct it");
    return value;
  }
  void skip(const Property& property, Type type, std::int64_t count) {
    for (; count > 0; --count) read(property, type);
  }
  void finish() {
    if (scanner_.next_line()) fail("more lines than the elements announced, correct the counts or remove them");
  }
  [[noreturn]] void fail(const std::string& message) const { scanner_.fail(message); }
  std::int64_t place() const { return scanner_.line(); }

 private:
  TextScanner scanner_;
};

/// The values of a binary body that begins at byte `offset` of `file`.
class BinaryValues {
 public:
  BinaryValues(std::string_view file, const std::string& name, std::size_t offset, bool big_endian)
      : file_(file), name_(name), offset_(offset), big_endian_(big_endian) {}

  void begin_element() { element_ = offset_; }
  void end_element() {}
  double read(const Property& property, Type type) {
    std::array<char, 8> bytes{};
    const std::size_t size = ply::size_of(type);
    require(property, size);
    std::memcpy(bytes.data(), file_.data() + offset_, size);
    offset_ += size;
    if (big_endian_) std::reverse(bytes.begin(), bytes.begin() + static_cast<std::ptrdiff_t>(size));
    return ply::value_of(bytes.data(), type);
  }
  void skip(const Property& property, Type type, std::int64_t count) {
    const std::size_t size = ply::size_of(type) * static_cast<std::size_t>(count);
    require(property, size);
    offset_ += size;
  }
  void finish() {
    if (offset_ != file_.size()) {
      fail_at_byte(name_, offset_,
                   std::to_string(file_.size() - offset_) +
                       " bytes behind the elements announced, correct the counts or remove them");
    }
  }
  [[noreturn]] void fail(const std::string& message) const { fail_at_byte(name_, element_, message); }
  std::int64_t place() const { return static_cast<std::int64_t>(element_); }

 private:
  void require(const Property& property, std::size_t size) const {
    if (size <= file_.size() - offset_) return;
    fail_at_byte(name_, offset_,
                 "the file ends within '" + property.name + "', it is truncated or its counts are wrong");
  }

  std::string_view file_;
  const std::string& name_;
  std::size_t offset_, element_ = 0;
  bool big_endian_;
};

template <class Values>
std::int64_t read_count(Values& values, const Property& property) {
  const double count = values.read(property, property.count_type);
  if (count < 0) values.fail("the list '" + property.name + "' has a negative length, correct it");
  return static_cast<std::int64_t>(count);
}

template <class Values>
void skip_property(Values& values, const Property& property) {
  values.skip(property, property.type, property.is_list ? read_count(values, property) : 1);
}

template <class Values>
void read_vertex(Values& values, const Element& element, PolygonSoup& soup) {
  std::array<double, 3> position{};
  for (const Property& property : element.properties) {
    const auto axis = property.is_list ? std::string::npos : ply::axis_of(property.name);
    if (axis == std::string::npos) {
      skip_property(values, property);
      continue;
    }
    position[axis] = values.read(property, property.type);
    if (!std::isfinite(position[axis])) {
      values.fail("vertex " + std::to_string(soup.vertex_count()) + ": " + property.name +
                  " is not finite, correct or remove it");
    }
  }
  soup.add_vertex(position[0], position[1], position[2]);
}

template <class Values>
void read_face(Values& values, const Element& element, PolygonSoup& soup) {
  const std::int64_t place = values.place();
  for (const Property& property : element.properties) {
    if (!ply::is_corner_list(property)) {
      skip_property(values, property);
      continue;
    }
    for (std::int64_t count = read_count(values, property); count > 0; --count) {
      soup.corners.push_back(static_cast<std::int64_t>(values.read(property, property.type)));
    }
  }
  soup.end_face(place);
}

template <class Values>
TriangleMesh read_body(Values values, const Header& header, PolygonSoup soup) {
  for (const Element& element : header.elements) {
    for (std::int64_t i = 0; i < element.count; ++i) {
      values.begin_element();
      if (element.name == "vertex") {
        read_vertex(values, element, soup);
      } else if (element.name == "face") {
        read_face(values, element, soup);
      } else {
        for (const Property& property : element.properties) skip_property(values, property);
      }
      values.end_element();
    }
  }
  values.finish();
  return triangulated(soup);
}

}  // namespace

TriangleMesh parse_ply(std::string_view text, const std::string& name) {
  const Header header = ply::parse_header(text, name);
  if (header.encoding == ply::Encoding::ascii) {
    const std::string_view body = text.substr(header.body_offset);
    if (body.empty()) fail_at_line(name, header.body_line - 1, "the file ends with its header, it is truncated");
    return read_body(TextValues(body, name, header.body_line), header, {.name = name});
  }
  const bool big_endian = header.encoding == ply::Encoding::big_endian;
  return read_body(BinaryValues(text, name, header.body_offset, big_endian), header,
                   {.name = name, .places_are_bytes = true});
}

}  // namespace skinbem
