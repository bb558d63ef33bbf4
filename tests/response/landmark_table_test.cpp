// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/response/landmark_table.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "text_reader.hpp"

namespace skinbem {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

/// Vertices (0,0,0), (10,0,0), (0,10,0), (0,0,10); its diagonal is 17.3.
TriangleMesh tetrahedron() {
  TriangleMesh mesh;
  mesh.vertices.resize(4, 3);
  mesh.vertices << 0, 0, 0, 10, 0, 0, 0, 10, 0, 0, 0, 10;
  mesh.triangles.resize(4, 3);
  mesh.triangles << 0, 2, 1, 0, 1, 3, 0, 3, 2, 1, 2, 3;
  return mesh;
}

LandmarkTable read_on_tetrahedron(const std::filesystem::path& path) {
  return read_landmarks(path, tetrahedron(), 1.5);
}

class LandmarkTableFile : public testing_support::TextReader<read_on_tetrahedron> {
 protected:
  LandmarkTableFile() : TextReader("landmarks.csv") {}
};

TEST_F(LandmarkTableFile, ReadsVerticesAndTheOptionalColumns) {
  const LandmarkTable table = read("name,vertex,radius,bone,bone_x,bone_y,bone_z\nA,1,2.5,tibia,1,2,-3e0\nB,2,,,,,\n");
  ASSERT_EQ(table.landmarks.size(), 2u);
  EXPECT_EQ(table.landmarks[0].name, "A");
  EXPECT_EQ(table.landmarks[0].vertex, 1);
  EXPECT_EQ(table.landmarks[0].radius, 2.5);
  EXPECT_EQ(table.landmarks[0].bone, "tibia");
  EXPECT_EQ(table.landmarks[0].bone_point.value(), Vec3(1, 2, -3));
  EXPECT_EQ(table.landmarks[1].radius, 1.5);
  EXPECT_FALSE(table.landmarks[1].bone_point.has_value());
  EXPECT_TRUE(table.snaps.empty());
}

TEST_F(LandmarkTableFile, KnowsMarksLineEndsQuotesCommentsAndBlankLines) {
  const LandmarkTable table = read(
      "\xef\xbb\xbf# made by hand\r\n\r\n name , skin_vertex\r\n\"A, the \"\"first\"\"\" , 3\r\n  \r\n# end\r\nB,+0");
  ASSERT_EQ(table.landmarks.size(), 2u);
  EXPECT_EQ(table.landmarks[0].name, "A, the \"first\"");
  EXPECT_EQ(table.landmarks[0].vertex, 3);
  EXPECT_EQ(table.landmarks[1].vertex, 0);
}

TEST_F(LandmarkTableFile, CoordinatesWinOverAnIndexThatLiesElsewhere) {
  const LandmarkTable table =
      read("name,skin_vertex,skin_x,skin_y,skin_z\nA,1,0,9.5,0\nB,3,0,0,10.000001\nC,,10,0,0\n");
  EXPECT_EQ(table.landmarks[0].vertex, 2);
  EXPECT_EQ(table.landmarks[1].vertex, 3);
  EXPECT_EQ(table.landmarks[2].vertex, 1);
  ASSERT_EQ(table.snaps.size(), 1u);
  EXPECT_EQ(table.snaps[0].name, "A");
  EXPECT_EQ(table.snaps[0].distance, 0.5);
  EXPECT_TRUE(table.snaps[0].vertex_overruled);
}

TEST_F(LandmarkTableFile, RefusesCoordinatesFarFromTheMesh) {
  EXPECT_THAT(error_of("name,x,y,z\nA,0,0,0\nB,1,1,1\n"),
              AllOf(HasSubstr("landmarks.csv:3: "), HasSubstr("not on the mesh")));
}

TEST_F(LandmarkTableFile, NamesTheLineAndTheDefectOfAMalformedFile) {
  struct Case {
    const char* text;
    const char* where;
    const char* what;
  };
  const Case cases[] = {
      {"", "landmarks.csv: ", "empty"},
      {"# only a comment\n", "landmarks.csv: ", "empty"},
      {"name,vertex\n", "landmarks.csv: ", "no landmark"},
      {"name,vertx\nA,1\n", "landmarks.csv:1: ", "unknown column 'vertx'"},
      {"name,vertex,vertex\nA,1,1\n", "landmarks.csv:1: ", "twice"},
      {"name,vertex,skin_vertex\nA,1,1\n", "landmarks.csv:1: ", "twice"},
      {"vertex\n1\n", "landmarks.csv:1: ", "'name'"},
      {"name,x,y\nA,1,1\n", "landmarks.csv:1: ", "neither"},
      {"name,vertex\n,1\n", "landmarks.csv:2: ", "no name"},
      {"name,vertex\nA,1\nA,2\n", "landmarks.csv:3: ", "twice"},
      {"name,vertex\nA,4\n", "landmarks.csv:2: ", "not on the mesh"},
      {"name,vertex\nA,-1\n", "landmarks.csv:2: ", "not on the mesh"},
      {"name,vertex\nA,1.5\n", "landmarks.csv:2: ", "whole number"},
      {"name,vertex\nA,99999999999999999999\n", "landmarks.csv:2: ", "whole number"},
      {"name,vertex\nA\n", "landmarks.csv:2: ", "1 fields"},
      {"name,vertex\nA,1,2\n", "landmarks.csv:2: ", "3 fields"},
      {"name,vertex\nA,\n", "landmarks.csv:2: ", "neither"},
      {"name,vertex,x,y,z\nA,,0,,0\n", "landmarks.csv:2: ", "all three"},
      {"name,x,y,z\nA,nan,0,0\n", "landmarks.csv:2: ", "finite"},
      {"name,x,y,z\nA,0,inf,0\n", "landmarks.csv:2: ", "finite"},
      {"name,vertex,radius\nA,1,-2\n", "landmarks.csv:2: ", "negative"},
      {"name,vertex,radius\nA,1,2mm\n", "landmarks.csv:2: ", "finite number"},
      {"name,vertex\n\"A,1\n", "landmarks.csv:2: ", "not closed"},
      {"name,vertex\n\"A\"b,1\n", "landmarks.csv:2: ", "quote"},
  };
  for (const Case& c : cases) {
    EXPECT_THAT(error_of(c.text), AllOf(HasSubstr(c.where), HasSubstr(c.what))) << c.text;
  }
}

TEST_F(LandmarkTableFile, AMissingFileIsAnErrorOfInput) {
  try {
    read_landmarks("/nowhere/landmarks.csv", tetrahedron(), 0);
    FAIL();
  } catch (const Error& error) {
    EXPECT_EQ(error.code(), ErrorCode::io);
  }
}

}  // namespace
}  // namespace skinbem
