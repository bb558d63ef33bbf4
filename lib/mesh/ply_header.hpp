// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The header of a PLY file: what its body holds.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

namespace skinbem::ply {

enum class Encoding { ascii, little_endian, big_endian };
enum class Type { int8, uint8, int16, uint16, int32, uint32, float32, float64 };

struct Property {
  std::string name;
  Type type = Type::float32;  ///< of the value, or of the values of a list
  bool is_list = false;
  Type count_type = Type::uint8;  ///< of a list's length
};

struct Element {
  std::string name;
  std::int64_t count = 0;  ///< as announced: not to be trusted with memory
  std::vector<Property> properties;
};

struct Header {
  Encoding encoding = Encoding::ascii;
  std::vector<Element> elements;
  std::size_t body_offset = 0;  ///< first byte behind the header
  std::int64_t body_line = 0;   ///< its line number
};

/// Throws Error(bad_input) with the line when the header is not one of PLY 1.0, or has no vertices with x, y, z or no
/// faces with vertex_indices (or vertex_index).
Header parse_header(std::string_view text, const std::string& name);

std::size_t size_of(Type type);
/// The value of `size_of(type)` bytes in the machine's byte order.
double value_of(const char* bytes, Type type);
/// Whether a number written as text is a value of `type`.
bool fits(double value, Type type);

/// 0, 1, 2 for x, y, z; npos else.
std::size_t axis_of(std::string_view property_name);
/// Whether the property of a face names its corners.
bool is_corner_list(const Property& property);

}  // namespace skinbem::ply
