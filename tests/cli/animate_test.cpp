// SPDX-License-Identifier: BSD-3-Clause
#include <cstring>
#include <map>
#include <nlohmann/json.hpp>

#include <skinbem/mesh/mesh_io.hpp>

#include "program.hpp"
#include "tolerances.hpp"

namespace skinbem::cli_testing {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;

/// The shipped limb, walking for six frames.
class Animate : public Program {
 protected:
  static Arguments limb() {
    return {"animate",     shipped("data/lower_limb/skin.obj"),
            "--landmarks", shipped("data/lower_limb/landmarks.csv"),
            "--radius",    "15",
            "--threads",   "1"};
  }
  static Arguments walk() {
    return {"--motion", shipped("data/lower_limb/walk.bvh"),
            "--rig",    shipped("data/lower_limb/rig.toml"),
            "--from",   "1",
            "--to",     "1.2",
            "--fps",    "25"};
  }
  /// Animates from a response that is computed once in a test.
  Outcome animate(const std::string& output, const Arguments& more = {}) {
    const std::string response = path("R.npy");
    if (!fs::exists(response)) {
      Arguments arguments = limb();
      arguments.front() = "response";
      EXPECT_EQ(run(arguments + Arguments{"-o", response}).code, 0);
    }
    return run(limb() + walk() + Arguments{"--response", response, "-o", path(output)} + more);
  }
  std::string glb(const Arguments& more = {}) {
    const Outcome outcome = animate("a.glb", more);
    EXPECT_EQ(outcome.code, 0) << outcome.err;
    return outcome.code == 0 ? read_file(path("a.glb")) : "";
  }
  std::vector<std::string> written_in(const std::string& folder) const {
    std::vector<std::string> names;
    for (const auto& entry : fs::directory_iterator(folder_ / folder)) names.push_back(entry.path().filename());
    std::sort(names.begin(), names.end());
    return names;
  }
};

/// Each triangle in four, the vertices of before first.
TriangleMesh subdivided(const TriangleMesh& mesh) {
  std::map<std::pair<int, int>, int> middles;
  std::vector<Eigen::RowVector3d> points;
  for (Index v = 0; v < mesh.vertex_count(); ++v) points.emplace_back(mesh.vertices.row(v));
  const auto middle = [&](int a, int b) {
    const auto [found, fresh] = middles.try_emplace(std::minmax(a, b), static_cast<int>(points.size()));
    if (fresh) points.emplace_back((mesh.vertices.row(a) + mesh.vertices.row(b)) / 2);
    return found->second;
  };
  TriangleMesh fine;
  fine.triangles.resize(4 * mesh.triangle_count(), 3);
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    const int a = mesh.triangles(t, 0), b = mesh.triangles(t, 1), c = mesh.triangles(t, 2);
    const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    fine.triangles.middleRows(4 * t, 4) << a, ab, ca, ab, b, bc, ca, bc, c, ab, bc, ca;
  }
  fine.vertices.resize(static_cast<Index>(points.size()), 3);
  for (std::size_t v = 0; v < points.size(); ++v) fine.vertices.row(static_cast<Index>(v)) = points[v];
  return fine;
}

TEST_F(Animate, WritesGlbPvdOrAFolderOfObj) {
  const Arguments bones{"--bones", shipped("data/lower_limb/bones")};
  const Outcome outcome = animate("a.glb", bones);
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  EXPECT_THAT(outcome.out, HasSubstr("frames     6 in "));
  EXPECT_THAT(outcome.out, HasSubstr("volume change"));
  EXPECT_THAT(read_file(path("a.glb")), testing::StartsWith("glTF"));

  ASSERT_EQ(animate("a.pvd").code, 0);
  EXPECT_THAT(read_file(path("a.pvd")), HasSubstr("a_frames/skin_000005.vtp"));
  EXPECT_EQ(written_in("a_frames").size(), 6u);

  ASSERT_EQ(animate("frames/", bones).code, 0);
  EXPECT_EQ(written_in("frames").size(), 12u);
  EXPECT_EQ(read_mesh(path("frames/skin_000005.obj")).vertex_count(), 606);
  EXPECT_EQ(read_mesh(path("frames/bones_000005.obj")).vertex_count(), 4797);
  EXPECT_THAT(written(), ElementsAre("R.npy", "a.glb", "a.pvd", "a_frames", "frames"));
}

TEST_F(Animate, ResponseFileGivesTheSameBytesAndSaysThatItWasAFile) {
  const std::string bytes = glb();
  const Outcome fresh = run(limb() + walk() + Arguments{"-o", path("b.glb"), "--json"});
  ASSERT_EQ(fresh.code, 0) << fresh.err;
  EXPECT_EQ(nlohmann::json::parse(fresh.out)["solver"], "dense");
  EXPECT_TRUE(bytes == read_file(path("b.glb")));

  const auto report = nlohmann::json::parse(animate("b.glb", {"--json"}).out);
  EXPECT_EQ(report["solver"], "file");
  for (const char* key : {"poisson", "tolerance", "estimated_error", "residual", "iterations"}) {
    EXPECT_TRUE(report[key].is_null()) << key;
  }
}

TEST_F(Animate, ArtefactsAreReproducibleBySeedAndOtherwiseDiffer) {
  const std::string none = glb({"--artefact", "none"});
  EXPECT_TRUE(none == glb());
  for (const char* kind : {"trial", "correlated", "frame"}) {
    const std::string first = glb({"--artefact", kind, "--seed", "3"});
    EXPECT_TRUE(first == glb({"--artefact", kind, "--seed", "3"})) << kind;
    EXPECT_FALSE(first == glb({"--artefact", kind, "--seed", "4"})) << kind;
    EXPECT_FALSE(first == none) << kind;
  }
}

TEST_F(Animate, ModesAndFramesAreDifferentMotions) {
  const std::string follow = glb({"--mode", "follow", "--frame", "corotated"});
  EXPECT_TRUE(follow == glb());
  EXPECT_FALSE(follow == glb({"--mode", "literal"}));
  EXPECT_FALSE(follow == glb({"--frame", "linear"}));
  expect_failure(animate("b.glb", {"--mode", "markers"}), 3, "markers");
}

TEST_F(Animate, PrintsTheQualityOfEveryFrame) {
  const Outcome outcome = animate("a.glb", {"--per-frame"});
  EXPECT_THAT(outcome.out, testing::StartsWith("frame,time,volume_change,edge_stretch,bones_outside\n0,1,"));
  EXPECT_EQ(lines(outcome.out), 7);
}

TEST_F(Animate, FinerSkinFollowsTheCoarseOne) {
  const TriangleMesh fine = subdivided(read_mesh(shipped("data/lower_limb/skin.obj")));
  write_mesh(path("fine.obj"), fine);
  ASSERT_EQ(animate("coarse/").code, 0);
  const Outcome outcome = animate("fine/", {"--skin", path("fine.obj")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  const Points of_coarse = read_mesh(path("coarse/skin_000003.obj")).vertices;
  const Points of_fine = read_mesh(path("fine/skin_000003.obj")).vertices;
  ASSERT_EQ(of_fine.rows(), fine.vertex_count());
  const double off = (of_fine.topRows(606) - of_coarse).rowwise().norm().maxCoeff();
  EXPECT_LT(off, tolerance::finer_skin);
  expect_failure(animate("b.glb", {"--skin", shipped("data/lower_limb/bones/tibia.obj")}), 3, "one body");
}

TEST_F(Animate, FolderOfALongerSequenceIsReplacedAndAForeignOneKept) {
  ASSERT_EQ(animate("frames/").code, 0);
  ASSERT_EQ(animate("frames/", {"--bones", shipped("data/lower_limb/bones")}).code, 0);
  ASSERT_EQ(animate("frames/").code, 0);
  EXPECT_EQ(written_in("frames").size(), 6u);
  fs::create_directory(path("mine"));
  file("mine/notes.txt", "mine");
  expect_failure(animate("mine/"), 5, "mine");
  EXPECT_THAT(written_in("mine"), ElementsAre("notes.txt"));
}

TEST_F(Animate, OutputsThatCannotBeAreNamed) {
  expect_failure(animate("a.xyz"), 2, "name a .glb, a .pvd or a folder/");
  expect_failure(animate("none/a.glb"), 5, "there is no folder");
  fs::create_directory(path("folder.glb"));
  expect_failure(animate("folder.glb"), 5, "is a directory");
  const std::string motion = file("walk.bvh", "HIERARCHY\n");
  expect_failure(run(limb() + Arguments{"--motion", motion, "--rig", shipped("data/lower_limb/rig.toml"), "-o",
                                        path("../") + folder_.path().filename().string() + "/walk.bvh"}),
                 2, "walk.bvh");
  EXPECT_THAT(written(), ElementsAre("R.npy", "folder.glb", "walk.bvh"));
}

TEST_F(Animate, MistakesInTheMotionComeBeforeTheSolveAndItsWarnings) {
  const Arguments of_box = Arguments{"animate"} + box() + Arguments{"-o", path("a.glb")};
  const std::string motion = shipped("data/lower_limb/walk.bvh"), rig = shipped("data/lower_limb/rig.toml");
  expect_failure(run(of_box + Arguments{"--motion", path("none.bvh"), "--rig", rig}), 5, "none.bvh");
  expect_failure(run(of_box + Arguments{"--motion", motion, "--rig", path("none.toml")}), 5, "none.toml");
  expect_failure(run(of_box + Arguments{"--motion", motion, "--rig", rig, "--from", "100"}), 2,
                 "no frame lies between");
}

TEST_F(Animate, InputsThatCannotBeAreNamed) {
  const std::string response = path("R.npy");
  ASSERT_NE(glb(), "");
  fs::remove(path("a.glb"));
  const std::string bvh = read_file(shipped("data/lower_limb/walk.bvh"));
  std::string rig = read_file(shipped("data/lower_limb/rig.toml"));
  rig.replace(rig.find("\"RightLeg\""), 10, "\"Nowhere\"");
  const auto with = [&](const std::string& motion, const std::string& rig_file, const Arguments& more = {}) {
    return run(limb() + Arguments{"--response", response, "--motion", motion, "--rig", rig_file, "-o", path("a.glb")} +
               more);
  };
  const std::string walk_file = shipped("data/lower_limb/walk.bvh"), rig_file = shipped("data/lower_limb/rig.toml");
  expect_failure(with(walk_file, file("rig.toml", rig)), 3, "Nowhere");
  expect_failure(with(walk_file, walk_file), 3, "walk.bvh");
  expect_failure(with(walk_file, path("none.toml")), 5, "none.toml: cannot read");
  expect_failure(with(path("none.bvh"), rig_file), 5, "none.bvh: cannot read");
  expect_failure(with(file("cut.bvh", bvh.substr(0, 20000)), rig_file), 3, "cut.bvh:");
  expect_failure(with(file("line.bvh", bvh.substr(0, bvh.rfind('\n', 20000) + 1)), rig_file), 3, "line.bvh");
  expect_failure(with(walk_file, rig_file, {"--from", "5", "--to", "4"}), 2, "no frame lies between");
  expect_failure(with(walk_file, rig_file, {"--bones", path("none")}), 5, "no such folder of bones");
  fs::copy_file(shipped("tests/reference/box_R_nu030.npy"), path("box.npy"));
  expect_failure(animate("a.glb", {"--mode", "literal", "--bones", folder_.path().string()}), 3, "holds no mesh");
  fs::rename(path("box.npy"), response);
  expect_failure(with(walk_file, rig_file), 3, "R.npy: is 54 by 9");
  EXPECT_FALSE(fs::exists(path("a.glb")));
}

TEST_F(Animate, ResponseOfOtherLandmarksOrDamagedIsRefused) {
  ASSERT_NE(glb(), "");
  const std::string good = read_file(path("R.npy")), of_others = "R.npy: does not move ";
  for (const double wrong : {1e300, 0.25}) {
    std::string bytes = good;
    std::memcpy(&bytes[bytes.size() - 8000], &wrong, sizeof wrong);
    file("R.npy", bytes);
    expect_failure(animate("b.glb"), 3, of_others);
  }
  file("R.npy", good);
  const auto with = [&](std::size_t argument, const std::string& other) {
    Arguments arguments = limb();
    arguments[argument] = other;
    return run(arguments + walk() + Arguments{"--response", path("R.npy"), "-o", path("b.glb")});
  };
  const std::string table = read_file(shipped("data/lower_limb/landmarks.csv"));
  const std::size_t first = table.find('\n') + 1, second = table.find('\n', first) + 1;
  const std::string rotated = table.substr(0, first) + table.substr(second) + table.substr(first, second - first);
  expect_failure(with(3, file("rotated.csv", rotated)), 3, of_others);
  expect_failure(with(5, "0"), 3, of_others);
  EXPECT_FALSE(fs::exists(path("b.glb")));
}

TEST_F(Animate, NumbersBeyondFloatsAreNotWritten) {
  const Arguments far{"--artefact", "trial", "--artefact-sigma", "1e60"};
  for (const char* output : {"a.glb", "a.pvd"}) expect_failure(animate(output, far), 4, "not finite");
  EXPECT_THAT(written(), ElementsAre("R.npy"));
}

}  // namespace
}  // namespace skinbem::cli_testing
