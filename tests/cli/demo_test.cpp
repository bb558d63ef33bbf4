// SPDX-License-Identifier: BSD-3-Clause
#include "program.hpp"

namespace skinbem::cli_testing {
namespace {

class Demo : public Program {};

TEST_F(Demo, WritesBothMotionsTheResponseAndTheLimbAndComparesWithThePaper) {
  const Outcome outcome = run({"demo", "-o", path("demo")});
  ASSERT_EQ(outcome.code, 0) << outcome.err;
  EXPECT_EQ(outcome.err, "");
  for (const char* what : {"606 vertices", "walk", "jump", "Tang (2010)", "244 s", "volume change"}) {
    EXPECT_THAT(outcome.out, testing::HasSubstr(what));
  }
  for (const char* name : {"walk.glb", "jump.glb", "walk.png", "jump.png", "response.npy", "lower_limb/skin.obj"}) {
    EXPECT_TRUE(fs::is_regular_file(folder_ / "demo" / name)) << name;
  }
  EXPECT_EQ(read_file(path("demo/lower_limb/skin.obj")), read_file(shipped("data/lower_limb/skin.obj")));
  EXPECT_THAT(read_file(path("demo/walk.png")), testing::StartsWith("\x89PNG"));
}

TEST_F(Demo, IntoAFileIsCode5) { expect_failure(run({"demo", "-o", file("taken", "")}), 5, "taken"); }

}  // namespace
}  // namespace skinbem::cli_testing
