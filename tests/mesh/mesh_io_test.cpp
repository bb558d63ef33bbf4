// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/mesh/mesh_io.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <bit>
#include <cstring>
#include <sstream>

#include <skinbem/base/atomic_file.hpp>
#include <skinbem/base/error.hpp>
#include <skinbem/mesh/mesh_formats.hpp>

#include "files.hpp"
#include "meshes.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using namespace testing_support;
using testing::AllOf;
using testing::HasSubstr;
using testing::Not;
using testing::StartsWith;

using Parser = TriangleMesh (*)(std::string_view, const std::string&);

/// The message of the refusal, which must be one line.
std::string refusal(Parser parse, std::string_view text) {
  try {
    parse(text, "m");
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::bad_input);
    EXPECT_THAT(error.what(), Not(HasSubstr("\n")));
    return error.what();
  }
  return "accepted";
}

void expect_equal(const TriangleMesh& a, const TriangleMesh& b) {
  EXPECT_EQ(a.vertices, b.vertices);
  EXPECT_EQ(a.triangles, b.triangles);
}

const std::string obj_points = "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 1\n";
const std::string obj_faces = "f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n";

TEST(ObjReader, ReadsEveryFormOfACorner) {
  for (const char* faces :
       {"f 1 3 2\nf 1 2 4\nf 1 4 3\nf 2 3 4\n", "f 1/1 3/1 2/1\nf 1/2 2/2 4/3\nf 1/1 4/1 3/1\nf 2/1 3/1 4/1\n",
        "f 1/1/1 3/1/1 2/1/1\nf 1//1 2//1 4//1\nf 1//2 4//2 3//2\nf 2 3 4\n",
        "f -4 -2 -3\nf -4 -3 -1\nf -4 -1 -2\nf -3 -2 -1\n"}) {
    expect_equal(parse_obj(obj_points + faces, "m"), tetrahedron());
  }
}

TEST(ObjReader, SkipsWhatASurfaceDoesNotNeed) {
  const std::string text = "# comment\nmtllib a.mtl\no thing\nvt 0 0\nvn 0 0 1\ng part\nusemtl red\ns off\n" +
                           obj_points + "l 1 2\np 1\n" + obj_faces;
  expect_equal(parse_obj(text, "m"), tetrahedron());
}

TEST(ObjReader, TakesWeightsColoursCommentsAndAnyLineEnd) {
  expect_equal(parse_obj("v 0 0 0 1\nv 1 0 0 .5 .5 .5\nv 0 1 0 # here\nv 0 0 1e0 1 0 0 1\n" + obj_faces, "m"),
               tetrahedron());
  for (const char* line_end : {"\r\n", "\r", "\n\n", " \t\n", " \\\n\n"}) {
    std::string text;
    for (const char c : obj_points + obj_faces) text += c == '\n' ? std::string(line_end) : std::string(1, c);
    expect_equal(parse_obj(text, "m"), tetrahedron());
  }
  expect_equal(parse_obj("\xEF\xBB\xBF" + obj_points + obj_faces, "m"), tetrahedron());
  expect_equal(parse_obj(obj_points + "f 1 \\\n 3\\\r\n 2\nf 1 2 4\nf 1 4 3\nf 2 3 4", "m"), tetrahedron());
}

TEST(ObjReader, CountsContinuedLines) {
  EXPECT_THAT(refusal(parse_obj, "v 0 \\\n 0 \\\n 0\nv x 0 0\n"), StartsWith("m:4: 'x' is not a number"));
}

TEST(ObjReader, RefusesEveryDefectOfTheFileWithItsLine) {
  const auto with = [](const char* text) { return refusal(parse_obj, obj_points + text); };
  EXPECT_THAT(with("f 1 2 5\n"), AllOf(StartsWith("m:5: "), HasSubstr("vertex 5"), HasSubstr("1 to 4")));
  EXPECT_THAT(with("f 1 2 0\n"), AllOf(StartsWith("m:5: "), HasSubstr("vertex 0")));
  EXPECT_THAT(with("f 1 2 -5\n"), AllOf(StartsWith("m:5: "), HasSubstr("vertex -5")));
  EXPECT_THAT(with("f 1 2 99999999999\n"), StartsWith("m:5: "));
  EXPECT_THAT(with("f 1 2 99999999999999999999999\n"), StartsWith("m:5: "));
  EXPECT_THAT(with("f 1 2\n"), AllOf(StartsWith("m:5: "), HasSubstr("2 corners")));
  EXPECT_THAT(with("f\n"), AllOf(StartsWith("m:5: "), HasSubstr("0 corners")));
  EXPECT_THAT(with("f 1 2 2\n"), AllOf(StartsWith("m:5: "), HasSubstr("twice")));
  EXPECT_THAT(with("f 1 2 3x\n"), StartsWith("m:5: '3x'"));
  EXPECT_THAT(with("f 1/ 2/ 3/\n"), StartsWith("m:5: "));
  EXPECT_THAT(with("f 1/1/1/1 2 3\n"), StartsWith("m:5: "));
  EXPECT_THAT(with("f 1.5 2 3\n"), StartsWith("m:5: "));
  EXPECT_THAT(with("face 1 2 3\n"), AllOf(StartsWith("m:5: "), HasSubstr("unknown keyword")));
  EXPECT_THAT(with("curv 0 1 1 2\n"), StartsWith("m:5: "));
  EXPECT_THAT(with(""), HasSubstr("no faces"));
  EXPECT_THAT(refusal(parse_obj, "f 1 2 3\n"), HasSubstr("no vertices"));
  for (const char* number :
       {"nan", "inf", "-inf", "NaN", "1e400", "-1e309", "1.0abc", "0x10", "1,5", "--1", "+-1", "+", "1e", "."}) {
    EXPECT_THAT(refusal(parse_obj, std::string("v 0 0 ") + number + "\n"), StartsWith("m:1: ")) << number;
  }
  EXPECT_THAT(refusal(parse_obj, "v 0 0\n"), StartsWith("m:1: "));
  EXPECT_THAT(refusal(parse_obj, "v 0 0 0 0 0\n"), StartsWith("m:1: "));
}

TEST(ObjReader, DoesNotContinueComments) {
  expect_equal(
      parse_obj("# saved to C:\\bodies\\\n" + obj_points + "f 1 3 2 # base \\\nf 1 2 4\nf 1 4 3\nf 2 3 4", "m"),
      tetrahedron());
}

TEST(ObjReader, ReadsNumbersTooSmallForADoubleAndPlusSigns) {
  const TriangleMesh mesh = parse_obj("v +1 1e-400 -1e-330\nv 1 0 0\nv 0 1 0\nf 1 2 3\n", "m");
  EXPECT_EQ(mesh.vertices.row(0), Eigen::RowVector3d(1, 0, 0));
}

TEST(ObjReader, NamesFilesThatAreNoText) {
  EXPECT_THAT(refusal(parse_obj, ""), HasSubstr("empty"));
  EXPECT_THAT(refusal(parse_obj, " \n\n"), HasSubstr("no vertices"));
  EXPECT_THAT(refusal(parse_obj, std::string_view("v 0 0 0\n\0\1\2", 11)),
              AllOf(StartsWith("m:2: "), HasSubstr("binary")));
  EXPECT_THAT(refusal(parse_obj, "\xFF\xFEv\n"), HasSubstr("UTF-16"));
  EXPECT_THAT(refusal(parse_obj, "\xC3\xA9\xC3\xA9 1 2 3\n"), StartsWith("m:1: unknown keyword '?"));
  EXPECT_LT(refusal(parse_obj, std::string(1000000, 'x')).size(), 200u);
}

TEST(Polygons, AreSplitSoThatAreaAndOrientationAreKept) {
  expect_equal(parse_obj("v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n", "m"),
               make_mesh({{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}}, {{0, 1, 2}, {0, 2, 3}}));
  // An arrowhead from each of its corners, and a comb that no fan can split.
  const std::string arrow = "v 0 0 1\nv 2 -2 1\nv 0 3 1\nv -2 -2 1\n";
  for (const char* face : {"f 1 2 3 4\n", "f 2 3 4 1\n", "f 3 4 1 2\n", "f 4 1 2 3\n"}) {
    const TriangleMesh mesh = parse_obj(arrow + face, "m");
    ASSERT_EQ(mesh.triangle_count(), 2);
    EXPECT_DOUBLE_EQ(area_vector(mesh, 0).z() + area_vector(mesh, 1).z(), 12);
    EXPECT_GT(std::min(area_vector(mesh, 0).z(), area_vector(mesh, 1).z()), 0);
  }
  const TriangleMesh comb = parse_obj(
      "v 0 0 0\nv 5 0 0\nv 5 3 0\nv 4 3 0\nv 4 1 0\nv 3 1 0\nv 3 3 0\nv 2 3 0\nv 2 1 0\nv 1 1 0\nv 1 3 0\nv 0 3 0\n"
      "f 1 2 3 4 5 6 7 8 9 10 11 12\n",
      "m");
  ASSERT_EQ(comb.triangle_count(), 10);
  double twice_area = 0;
  for (Index t = 0; t < 10; ++t) {
    EXPECT_GT(area_vector(comb, t).z(), 0);
    twice_area += area_vector(comb, t).z();
  }
  EXPECT_DOUBLE_EQ(twice_area, 22);
}

TEST(Polygons, OfAThousandCornersAndOfNoAreaAreSurvived) {
  std::string text, face = "f";
  for (int i = 1; i <= 1000; ++i) {
    text += "v " + std::to_string(std::cos(i * 0.006)) + " " + std::to_string(std::sin(i * 0.006)) + " 0\n";
    face.append(" ").append(std::to_string(i));
  }
  EXPECT_EQ(parse_obj(text + face + "\n", "m").triangle_count(), 998);
  EXPECT_THAT(refusal(parse_obj, text + "v 0 0 0\n" + face + " 1001\n"), HasSubstr("1001 corners"));
  EXPECT_EQ(parse_obj("v 0 0 0\nv 1 0 0\nv 2 0 0\nv 3 0 0\nf 1 2 3 4\n", "m").triangle_count(), 2);
}

const std::string off_text = "OFF\n4 4 6\n0 0 0\n1 0 0\n0 1 0\n0 0 1\n3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n";

TEST(OffReader, ReadsColoursCommentsAndCountsOnTheFirstLine) {
  expect_equal(parse_off(off_text, "m"), tetrahedron());
  expect_equal(parse_off("# c\nCOFF # c\n# c\n4 4 0\n\n0 0 0 1 0 0 1\n1 0 0 1 0 0 1\n0 1 0 1 0 0 1\n0 0 1 1 0 0 1\n"
                         "3 0 2 1 0.5 0.5 0.5\n3 0 1 3\n3 0 3 2\n3 1 2 3 7\n# c\n",
                         "m"),
               tetrahedron());
  expect_equal(parse_off("OFF 4 4\r\n" + off_text.substr(10), "m"), tetrahedron());
}

TEST(OffReader, RefusesEveryDefectOfTheFileWithItsLine) {
  const auto line = [](int number, const char* text) {
    std::string result, rest = off_text;
    for (int i = 1; !rest.empty(); ++i) {
      const auto end = rest.find('\n') + 1;
      result += i == number ? std::string(text) : rest.substr(0, end);
      rest.erase(0, end);
    }
    return refusal(parse_off, result);
  };
  EXPECT_THAT(line(1, ""), AllOf(StartsWith("m:1: "), HasSubstr("OFF")));
  EXPECT_THAT(line(1, "4OFF\n"), StartsWith("m:1: "));
  EXPECT_THAT(line(1, "OFF BINARY\n"), HasSubstr("binary OFF"));
  EXPECT_THAT(line(2, "4 -4 0\n"), StartsWith("m:2: "));
  EXPECT_THAT(line(2, "4 5 0\n"), AllOf(HasSubstr("4 of the 5 faces"), HasSubstr("truncated")));
  EXPECT_THAT(line(2, "4 3 0\n"), AllOf(StartsWith("m:10: "), HasSubstr("more lines")));
  EXPECT_THAT(line(2, "4 9000000000000000000 0\n"), HasSubstr("truncated"));
  EXPECT_THAT(line(2, "9000000000000000000 4 0\n"), HasSubstr("truncated"));
  EXPECT_THAT(line(4, "1 0 nan\n"), StartsWith("m:4: 'nan'"));
  EXPECT_THAT(line(4, "1 0\n"), StartsWith("m:4: "));
  EXPECT_THAT(line(7, "3 0 2 4\n"), AllOf(StartsWith("m:7: "), HasSubstr("0 to 3")));
  EXPECT_THAT(line(7, "3 0 2 -1\n"), StartsWith("m:7: "));
  EXPECT_THAT(line(7, "3 0 2 2\n"), StartsWith("m:7: "));
  EXPECT_THAT(line(7, "2 0 2\n"), StartsWith("m:7: "));
  EXPECT_THAT(line(7, "-3 0 2 1\n"), StartsWith("m:7: "));
  EXPECT_THAT(line(7, "4000000000 0 2 1\n"), StartsWith("m:7: "));
  EXPECT_THAT(line(7, "3 0 2 1 red\n"), StartsWith("m:7: 'red'"));
  EXPECT_THAT(refusal(parse_off, ""), HasSubstr("empty"));
}

std::string stl_text() {
  std::string text = "solid t\n";
  const TriangleMesh mesh = tetrahedron();
  for (Index t = 0; t < 4; ++t) {
    text += " facet normal nan 0 0\n  outer loop\n";
    for (int c = 0; c < 3; ++c) {
      const Vec3 p = mesh.corner(t, c);
      text += "   vertex " + std::to_string(p.x()) + " " + std::to_string(p.y()) + " " + std::to_string(p.z()) + "\n";
    }
    text += "  endloop\n endfacet\n";
  }
  return text + "endsolid t\n";
}

std::string written(void (*write)(std::ostream&, const TriangleMesh&), const TriangleMesh& mesh) {
  std::ostringstream out;
  write(out, mesh);
  return out.str();
}

TEST(StlReader, WeldsInTheOrderOfFirstAppearance) {
  const TriangleMesh expected =
      make_mesh({{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}}, {{0, 1, 2}, {0, 2, 3}, {0, 3, 1}, {2, 1, 3}});
  expect_equal(parse_stl(stl_text(), "m"), expected);
  expect_equal(parse_stl(written(write_stl, tetrahedron()), "m"), expected);
}

TEST(StlReader, TellsBinaryFromTextByItsSizeAndContentNotByItsFirstWord) {
  std::string binary = written(write_stl, tetrahedron());
  std::memcpy(binary.data(), "solid x\n", 8);
  EXPECT_EQ(parse_stl(binary, "m").triangle_count(), 4);
  binary.pop_back();
  EXPECT_THAT(refusal(parse_stl, binary), HasSubstr("truncated"));
}

TEST(StlReader, TakesKeywordsInAnyLetters) {
  for (const char* text : {"SOLID\nFACET NORMAL 0 0 1\nOUTER LOOP\nVERTEX 0 0 0\nVERTEX 1 0 0\nVERTEX 0 1 0\nENDLOOP\n"
                           "ENDFACET\nENDSOLID\n",
                           "Solid\nFacet Normal 0 0 1\nOuter Loop\nVertex 0 0 0\nVertex 1 0 0\nVertex 0 1 0\nEndLoop\n"
                           "EndFacet\nEndSolid\n"}) {
    EXPECT_EQ(parse_stl(text, "m").triangle_count(), 1);
  }
}

TEST(StlReader, RefusesEveryDefectOfTheFileWithItsPlace) {
  const auto replaced = [](std::string_view from, const std::string& to) {
    std::string text = stl_text();
    return refusal(parse_stl, text.replace(text.find(from), from.size(), to));
  };
  EXPECT_THAT(replaced("vertex 0.0", "vertex nan"), StartsWith("m:4: 'nan"));
  EXPECT_THAT(replaced("vertex 0.0", "vertex 0.0x"), StartsWith("m:4: "));
  EXPECT_THAT(replaced("endloop", "vertex 0 0 0\nendloop"), StartsWith("m:7: "));
  EXPECT_THAT(replaced("solid", "liquid"), StartsWith("m:1: "));
  EXPECT_THAT(replaced("endsolid t\n", ""), HasSubstr("truncated"));
  EXPECT_THAT(replaced("endsolid t\n", "endsolid t\nmore\n"), StartsWith("m:31: "));
  EXPECT_THAT(refusal(parse_stl, "solid\nendsolid\n"), HasSubstr("no facets"));
  std::string binary = written(write_stl, tetrahedron());
  const float nan = std::nanf("");
  std::memcpy(binary.data() + 84 + 50 + 12 + 4, &nan, 4);
  EXPECT_THAT(refusal(parse_stl, binary), HasSubstr("byte 150: facet 1"));
  binary = written(write_stl, tetrahedron());
  binary[83] = '\x7F';
  EXPECT_THAT(refusal(parse_stl, binary), HasSubstr("byte 80"));
  EXPECT_THAT(refusal(parse_stl, written(write_stl, tetrahedron()) + "x"), HasSubstr("byte 80"));
  EXPECT_THAT(refusal(parse_stl, written(write_stl, TriangleMesh{})), HasSubstr("no facets"));
}

TEST(StlWriter, RefusesCoordinatesBeyondFloats) {
  EXPECT_THROW(written(write_stl, stretched(tetrahedron(), {1e39, 1, 1})), Error);
}

const std::string ply_head =
    "element vertex 4\nproperty float x\nproperty float y\nproperty uchar red\nproperty double z\n"
    "element face 4\nproperty short id\nproperty list uchar int vertex_indices\nproperty list uint float extra\n"
    "element edge 1\nproperty list int16 ushort ends\nend_header\n";

std::string ply_text() {
  return "ply\nformat ascii 1.0\ncomment c\nobj_info o\n" + ply_head +
         "0 0 255 0\n1 0 9 0\n0 1 9 0\n0 0 9 1\n7 3 0 2 1 0\n7 3 0 1 3 1 nan\n7 3 0 3 2 2 .5 .5\n7 3 1 2 3 0\n2 0 1\n";
}

/// The same file in binary.
std::string ply_binary(std::endian order) {
  std::string result =
      "ply\nformat binary_" + std::string(order == std::endian::big ? "big" : "little") + "_endian 1.0\n" + ply_head;
  const auto put = [&](auto value) {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    if (order != std::endian::native) bytes.assign(bytes.rbegin(), bytes.rend());
    result += bytes;
  };
  const TriangleMesh mesh = tetrahedron();
  for (Index v = 0; v < 4; ++v) {
    put(static_cast<float>(mesh.vertices(v, 0))), put(static_cast<float>(mesh.vertices(v, 1)));
    put(std::uint8_t{200}), put(mesh.vertices(v, 2));
  }
  for (Index t = 0; t < 4; ++t) {
    put(std::int16_t{7}), put(std::uint8_t{3});
    for (int c = 0; c < 3; ++c) put(mesh.triangles(t, c));
    put(static_cast<std::uint32_t>(t));
    for (Index i = 0; i < t; ++i) put(0.5f);
  }
  put(std::int16_t{2}), put(std::uint16_t{0}), put(std::uint16_t{1});
  return result;
}

TEST(PlyReader, ReadsAllEncodingsAndSkipsOtherElementsAndProperties) {
  expect_equal(parse_ply(ply_text(), "m"), tetrahedron());
  expect_equal(parse_ply(ply_binary(std::endian::little), "m"), tetrahedron());
  expect_equal(parse_ply(ply_binary(std::endian::big), "m"), tetrahedron());
  std::string windows;
  for (const char c : ply_text()) windows += c == '\n' ? std::string("\r\n") : std::string(1, c);
  expect_equal(parse_ply(windows, "m"), tetrahedron());
}

TEST(PlyReader, RefusesEveryDefectOfTheFileWithItsPlace) {
  const auto replaced = [](std::string_view from, const std::string& to, std::string text = ply_text()) {
    return refusal(parse_ply, text.replace(text.find(from), from.size(), to));
  };
  EXPECT_THAT(refusal(parse_ply, ""), HasSubstr("empty"));
  EXPECT_THAT(replaced("ply", "play"), StartsWith("m:1: "));
  EXPECT_THAT(replaced("ascii", "binary_middle_endian"), StartsWith("m:2: "));
  EXPECT_THAT(replaced("1.0", "2.0"), StartsWith("m:2: "));
  EXPECT_THAT(replaced("format ascii 1.0\n", ""), HasSubstr("no 'format'"));
  EXPECT_THAT(replaced("property float x", "property half x"), StartsWith("m:6: unknown type 'half'"));
  EXPECT_THAT(replaced("float x", "float y"), HasSubstr("twice"));
  EXPECT_THAT(replaced("float x", "float a"), HasSubstr("x, y and z"));
  EXPECT_THAT(replaced("vertex_indices", "corners"), HasSubstr("vertex_indices"));
  EXPECT_THAT(replaced("list uchar int", "list float int"), HasSubstr("length of a list"));
  EXPECT_THAT(replaced("element face 4", "element quad 4"), HasSubstr("'face'"));
  EXPECT_THAT(replaced("end_header", "endheader"), HasSubstr("end_header"));
  EXPECT_THAT(replaced("vertex 4", "vertex -4"), StartsWith("m:5: "));
  EXPECT_THAT(replaced("vertex 4", "vertex 3"), StartsWith("m:20: "));
  EXPECT_THAT(replaced("edge 1", "edge 9000000000000000000"), HasSubstr("truncated"));
  EXPECT_THAT(replaced("element edge", "element nothing 4000000000\nelement edge"), HasSubstr("no properties"));
  EXPECT_THAT(replaced("2 0 1\n", "2 0 1\n2 0 1\n"), AllOf(StartsWith("m:26: "), HasSubstr("more lines")));
  EXPECT_THAT(replaced("1 0 9 0", "nan 0 9 0"), AllOf(StartsWith("m:18: "), HasSubstr("not finite")));
  EXPECT_THAT(replaced("1 0 9 0", "1 0 256 0"), StartsWith("m:18: "));
  EXPECT_THAT(replaced("1 0 9 0", "1 0 9 0 0"), StartsWith("m:18: "));
  EXPECT_THAT(replaced("3 0 2 1", "3 0 2 4"), AllOf(StartsWith("m:21: "), HasSubstr("0 to 3")));
  EXPECT_THAT(replaced("3 0 2 1", "3 0 2 -2147483648"), StartsWith("m:21: "));
  EXPECT_THAT(replaced("3 0 2 1", "3 0 2 1.5"), StartsWith("m:21: "));
  EXPECT_THAT(replaced("3 0 2 1", "0"), AllOf(StartsWith("m:21: "), HasSubstr("0 corners")));
  EXPECT_THAT(replaced("3 0 2 1", "1 0"), StartsWith("m:21: "));
  EXPECT_THAT(replaced("3 0 2 1", "2 0 1"), StartsWith("m:21: "));
  EXPECT_THAT(replaced("3 0 2 1", "-1"), StartsWith("m:21: "));
  const std::string binary = ply_binary(std::endian::big);
  EXPECT_THAT(replaced("vertex 4", "vertex 4000000000", binary), HasSubstr("byte"));
  EXPECT_THAT(replaced("edge 1", "edge 4000000000", binary), HasSubstr("truncated"));
  EXPECT_THAT(refusal(parse_ply, binary + "x"), HasSubstr("1 bytes behind"));
  EXPECT_THAT(refusal(parse_ply, binary.substr(0, binary.size() - 1)), HasSubstr("truncated"));
}

/// A prefix that parses is a mesh; any other is a one-line Error; nothing else may happen.
void expect_no_prefix_to_crash(Parser parse, const std::string& text) {
  for (std::size_t size = 0; size <= text.size(); ++size) {
    const std::string prefix = text.substr(0, size);  // a copy, so that reading behind it is seen by sanitizers
    const std::string outcome = refusal(parse, prefix);
    if (outcome == "accepted") {
      EXPECT_GE(parse(prefix, "m").triangles.minCoeff(), 0);
    }
  }
}

/// Each byte replaced by some nasty ones.
void expect_no_change_to_crash(Parser parse, std::string text) {
  for (char& byte : text) {
    const char old = byte;
    for (const char other : {'\0', '\xFF', '\x7F', '-', '9', '\n', '\\', ' '}) {
      byte = other;
      refusal(parse, text);
    }
    byte = old;
  }
}

TEST(Readers, SurviveEveryPrefixAndEveryChangedByte) {
  const std::pair<Parser, std::string> files[] = {{parse_obj, obj_points + obj_faces},
                                                  {parse_off, off_text},
                                                  {parse_stl, stl_text()},
                                                  {parse_stl, written(write_stl, tetrahedron())},
                                                  {parse_ply, ply_text()},
                                                  {parse_ply, ply_binary(std::endian::little)},
                                                  {parse_ply, ply_binary(std::endian::big)}};
  for (const auto& [parse, text] : files) {
    expect_no_prefix_to_crash(parse, text);
    expect_no_change_to_crash(parse, text);
  }
}

TEST(MeshFiles, ComeBackBitByBitFromObjOffAndPly) {
  TemporaryFolder folder;
  const TriangleMesh mesh = moved(icosphere(2, 123.456), {1e-7, 1.0 / 3, 1e12});
  for (const char* name : {"a.obj", "a.OFF", "a.Ply"}) {
    write_mesh(folder / name, mesh);
    expect_equal(read_mesh(folder / name), mesh);
  }
}

TEST(MeshFiles, ComeBackFromStlAsTheSameTrianglesInFloat) {
  TemporaryFolder folder;
  const TriangleMesh mesh = icosphere(2, 123.456);
  write_mesh(folder / "a.stl", mesh);
  const TriangleMesh back = read_mesh(folder / "a.stl");
  ASSERT_EQ(back.triangle_count(), mesh.triangle_count());
  EXPECT_EQ(back.vertex_count(), mesh.vertex_count());
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    for (int c = 0; c < 3; ++c) EXPECT_EQ(back.corner(t, c).cast<float>(), mesh.corner(t, c).cast<float>());
  }
}

TEST(MeshFiles, AreWeldedOnRequest) {
  TemporaryFolder folder;
  write_mesh(folder / "soup.obj", soup(icosphere(1)));
  EXPECT_EQ(read_mesh(folder / "soup.obj").vertex_count(), 240);
  EXPECT_EQ(read_mesh(folder / "soup.obj", {.weld = true}).vertex_count(), 42);
}

TEST(MeshFiles, UnknownExtensionsAndMissingFilesAreNamed) {
  TemporaryFolder folder;
  const auto code = [](auto action) {
    try {
      action();
    } catch (const Error& error) {
      return error.code();
    }
    return ErrorCode::cancelled;
  };
  EXPECT_EQ(code([&] { read_mesh(folder / "a.xyz"); }), ErrorCode::usage);
  EXPECT_EQ(code([&] { write_mesh(folder / "a", tetrahedron()); }), ErrorCode::usage);
  EXPECT_EQ(code([&] { read_mesh(folder / "a.obj"); }), ErrorCode::io);
  EXPECT_EQ(code([&] { write_mesh(folder / "no/a.obj", tetrahedron()); }), ErrorCode::io);
  EXPECT_EQ(code([&] { write_mesh(folder / "a.obj", stretched(tetrahedron(), Vec3::Constant(std::nan("")))); }),
            ErrorCode::bad_input);
  EXPECT_TRUE(fs::is_empty(folder.path()));
}

}  // namespace
}  // namespace skinbem
