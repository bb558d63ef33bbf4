// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/motion/rig.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/LU>

#include "text_reader.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string leg = R"([mesh]
up = "+z"
forward = "-y"   # the toes
floor = 0

[motion]
format = "bvh"
up = "+y"
forward = "+z"

[segments.foot]
parent = "shank"
bones = ["talus", "bones/calcaneus.obj"]
proximal = [0, 0, 80]
distal = [0, -120, 20]
axis = [1, 0, 0]
proximal_joint = "Foot"
distal_joint = "Toe"
motion_axis = [2, 0, 0]

[segments.shank]
bones = ["tibia",
         "fibula"]
landmarks = ["LE"]
proximal = [0, 0, 430]
distal = [0, 0, 80]
axis = [1, 0, 0]
proximal_joint = "Leg"
distal_joint = "Foot"
motion_axis = [1, 0, 0]
)";

class RigFileText : public testing_support::TextReader<read_rig> {
 protected:
  RigFileText() : TextReader("leg.toml") {}
  std::string error_with(const std::string& from, const std::string& to) { return error_of(leg, from, to); }
};

TEST_F(RigFileText, ParentsComeBeforeTheirChildren) {
  const Rig rig = read(leg);
  ASSERT_EQ(rig.segments.size(), 2u);
  EXPECT_EQ(rig.segments[0].name, "shank");
  EXPECT_EQ(rig.segments[0].parent, -1);
  EXPECT_EQ(rig.segments[1].parent, 0);
  EXPECT_EQ(rig.segments[1].joint, Vec3(0, 0, 80));
  EXPECT_EQ(rig.segments[1].motion_axis, Vec3(1, 0, 0));
  EXPECT_EQ(rig.scale_segment, "shank");
}

TEST_F(RigFileText, BonesAreKnownByTheirNamesOrFiles) {
  const Rig rig = read(leg);
  EXPECT_EQ(rig.segment_of_bone("bones/tibia.obj"), 0);
  EXPECT_EQ(rig.segment_of_bone("fibula"), 0);
  EXPECT_EQ(rig.segment_of_bone("calcaneus"), 1);
  EXPECT_EQ(rig.segment_of_bone("femur"), -1);
}

TEST_F(RigFileText, AxesOfTheFileBecomeThoseOfTheMesh) {
  const Rig rig = read(leg);
  EXPECT_LE((rig.axes * Vec3(0, 1, 0) - Vec3(0, 0, 1)).norm(), tolerance::rounding);
  EXPECT_LE((rig.axes * Vec3(0, 0, 1) - Vec3(0, -1, 0)).norm(), tolerance::rounding);
  EXPECT_NEAR(rig.axes.determinant(), 1, tolerance::rounding);
}

TEST_F(RigFileText, NamesTheLineAndTheDefectOfAMalformedFile) {
  EXPECT_THAT(error_of(""), HasSubstr("format"));
  EXPECT_THAT(error_with("\"bvh\"", "\"fbx\""), AllOf(HasSubstr("leg.toml:7: "), HasSubstr("format")));
  EXPECT_THAT(error_with("up = \"+z\"", "up = \"+w\""), AllOf(HasSubstr("leg.toml:2: "), HasSubstr("axis")));
  EXPECT_THAT(error_with("forward = \"-y\"", "forward = \"-z\""),
              AllOf(HasSubstr("leg.toml:3: "), HasSubstr("different")));
  EXPECT_THAT(error_with("floor = 0", "flor = 0"), AllOf(HasSubstr("leg.toml:1: "), HasSubstr("no 'floor'")));
  EXPECT_THAT(error_with("floor = 0", "floor = nan"), AllOf(HasSubstr("leg.toml:4: "), HasSubstr("finite")));
  EXPECT_THAT(error_with("floor = 0", "floor = 0\nflor = 1"),
              AllOf(HasSubstr("leg.toml:5: "), HasSubstr("unknown key 'flor'")));
  EXPECT_THAT(error_with("floor = 0", "floor = 0\nfloor = 1"), AllOf(HasSubstr("leg.toml:5: "), HasSubstr("twice")));
  EXPECT_THAT(error_with("[segments.foot]", "[segments.shank]"), AllOf(HasSubstr("leg.toml:21: "), HasSubstr("twice")));
  EXPECT_THAT(error_with("[segments.foot]", "[segment.foot]"),
              AllOf(HasSubstr("leg.toml:1"), HasSubstr("unknown key")));
  EXPECT_THAT(error_with("parent = \"shank\"", "parent = \"thigh\""),
              AllOf(HasSubstr("leg.toml:12: "), HasSubstr("no segment")));
  EXPECT_THAT(error_with("parent = \"shank\"", ""), HasSubstr("exactly one segment"));
  EXPECT_THAT(error_with("parent = \"shank\"", "parent = \"foot\""), HasSubstr("descend"));
  EXPECT_THAT(error_with("\"talus\"", "\"tibia\""), HasSubstr("bone 'tibia' is named twice"));
  EXPECT_THAT(error_with("[0, 0, 80]", "[0, 0]"), AllOf(HasSubstr("leg.toml:14: "), HasSubstr("three numbers")));
  EXPECT_THAT(error_with("[0, 0, 80]", "[0, 0, x]"), AllOf(HasSubstr("leg.toml:14: "), HasSubstr("three finite")));
  EXPECT_THAT(error_with("axis = [1, 0, 0]", "axis = [0, 2, 1]"),
              AllOf(HasSubstr("leg.toml:16: "), HasSubstr("along")));
  EXPECT_THAT(error_with("axis = [1, 0, 0]", "axis = [0, 0, 0]"),
              AllOf(HasSubstr("leg.toml:16: "), HasSubstr("not zero")));
  EXPECT_THAT(error_with("axis = [1, 0, 0]", "axis"), AllOf(HasSubstr("leg.toml:"), HasSubstr("axis")));
  EXPECT_THAT(error_with("\"bvh\"", "\"bvh\"\nscale = \"thigh\""),
              AllOf(HasSubstr("leg.toml:8: "), HasSubstr("scale")));
  EXPECT_THAT(error_with("\"bvh\"", "\"bvh\"\nscale = 0"), HasSubstr("positive"));
}

TEST(ShippedRigs, AreRead) {
  for (const char* name : {"real_leg_cmu", "real_leg_opensim"}) {
    const Rig rig = read_rig(testing_support::project_file("data/rigs/" + std::string(name) + ".toml"));
    EXPECT_EQ(rig.segments.size(), 3u);
    for (const char* bone : {"bones/tibia.obj", "fibula", "phalanx_distal_5", "femur"}) {
      EXPECT_GE(rig.segment_of_bone(bone), 0) << bone;
    }
  }
}

}  // namespace
}  // namespace skinbem
