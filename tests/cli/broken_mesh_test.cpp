// SPDX-License-Identifier: BSD-3-Clause
#include "program.hpp"

namespace skinbem::cli_testing {
namespace {

using testing::HasSubstr;
using testing_support::shared_data;

class BrokenMesh : public Program {
 protected:
  static std::string broken(const std::string& name) { return shared_data("more_meshes/broken/" + name).string(); }
  /// `response` of a mesh of at least eight vertices.
  Outcome response(const std::string& mesh, const Arguments& more = {}) {
    const std::string landmarks = file("landmarks.csv", "name,vertex\na,0\nb,3\nc,5\nd,6\n");
    return run(Arguments{"response", mesh, "--landmarks", landmarks, "-o", path("R.npy")} + more);
  }
};

/// `check` lists defects on stdout, so only its message is looked at.
void expect_named(const Outcome& outcome, const std::string& why) {
  EXPECT_EQ(outcome.code, 3) << outcome.err;
  EXPECT_EQ(lines(outcome.err), 1) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr(why));
}

TEST_F(BrokenMesh, EveryDefectIsNamedWithItsPlaceInOneLine) {
  SKINBEM_NEEDS_SHARED_DATA("more_meshes/broken");
  const std::vector<std::pair<std::string, std::string>> defects{
      {"open_hole", ": 6 open edges, the first edge between vertices 5 and 10 at ("},
      {"nonmanifold_edge", ": 1 non-manifold edge: edge between vertices 31 and 69 at ("},
      {"flipped_triangle", "inconsistent orientation): triangle 30 at ("},
      {"inside_out", ": 1 surface inside out: the one of triangle 0 at ("},
      {"duplicated_vertices", "--weld"},
      {"degenerate_triangle_index", ".obj:429: degenerate face: vertex 90 twice"},
      {"self_intersection", "--force"},
      {"nan_coordinate", ".obj:8: 'nan' is not finite"},
      {"index_out_of_range", ".obj:428: face refers to vertex 145"},
      {"empty", "the file is empty"},
      {"binary_garbage", ".obj:1: binary data"},
      {"unreferenced_vertex", ": 1 unreferenced vertex: vertex 144 at ("},
  };
  for (const auto& [name, why] : defects) {
    SCOPED_TRACE(name);
    expect_named(run({"check", broken(name + ".obj")}), why);
    expect_failure(response(broken(name + ".obj")), 3, why);
    EXPECT_THAT(written(), testing::ElementsAre("landmarks.csv"));
  }
}

TEST_F(BrokenMesh, BodiesOfTheSameFolderAreAccepted) {
  SKINBEM_NEEDS_SHARED_DATA("more_meshes/broken");
  for (const char* name : {"valid_reference.obj", "nested_component.obj", "quads_only.obj"}) {
    EXPECT_EQ(run({"check", broken(name)}).code, 0) << name;
    const Outcome outcome = response(broken(name));
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    EXPECT_EQ(outcome.err, "") << "progress is for terminals only";
  }
}

TEST_F(BrokenMesh, WeldMakesABodyOfASoup) {
  SKINBEM_NEEDS_SHARED_DATA("more_meshes/broken");
  const Outcome outcome = run({"check", broken("duplicated_vertices.obj"), "--weld"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.out, HasSubstr("144 vertices, 284 triangles"));
  EXPECT_EQ(response(broken("duplicated_vertices.obj"), {"--weld"}).code, 0);
}

TEST_F(BrokenMesh, ForceTakesASelfIntersectionWithAWarning) {
  SKINBEM_NEEDS_SHARED_DATA("more_meshes/broken");
  const Outcome outcome = response(broken("self_intersection.obj"), {"--force"});
  EXPECT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_THAT(outcome.err, HasSubstr("warning"));
  EXPECT_THAT(outcome.err, HasSubstr("self-intersections"));
}

TEST_F(BrokenMesh, ForceTakesNothingElse) {
  SKINBEM_NEEDS_SHARED_DATA("more_meshes/broken");
  EXPECT_EQ(response(broken("open_hole.obj"), {"--force"}).code, 3);
}

TEST_F(BrokenMesh, ACheckOfAnOpenSurfaceListsItsDefects) {
  const Outcome outcome = run({"check", file("one.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n")});
  expect_named(outcome, "3 open edges");
  EXPECT_THAT(outcome.out, testing::StartsWith("open_edge: 3 open edges"));
}

TEST_F(BrokenMesh, MissingFilesAreCode5) {
  expect_failure(run({"check", path("none.obj")}), 5, "none.obj: cannot read: No such file");
  expect_failure(response(path("none.obj")), 5, "none.obj: cannot read: No such file");
}

TEST_F(BrokenMesh, WhatIsNoMeshIsSaidToBeNone) {
  EXPECT_EQ(run({"check", folder_.path().string()}).code, 2);
  expect_failure(run({"check", file("mesh.txt", "v 0 0 0\n")}), 2, "unknown mesh format");
  expect_failure(run({"check", file("points.obj", "v 0 0 0\nv 1 0 0\n")}), 3, "no faces");
}

}  // namespace
}  // namespace skinbem::cli_testing
