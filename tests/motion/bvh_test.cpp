// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/motion/bvh.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "text_reader.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;

const std::string arm = R"(HIERARCHY
ROOT base
{
  OFFSET 0 0 0
  CHANNELS 6 Zposition Xposition Yposition Xrotation Zrotation Yrotation
  JOINT elbow
  {
    OFFSET 0 2 0
    CHANNELS 3 Zrotation Yrotation Xrotation
    End Site
    {
      OFFSET 0 1 0
    }
  }
}
MOTION
Frames: 2
Frame Time: 0.04
0 0 0 0 0 0 0 0 0
30 10 20 90 0 0 90 0 0
)";

class BvhFile : public testing_support::TextReader<read_bvh> {
 protected:
  BvhFile() : TextReader("motion.bvh") {}
  std::string error_with(const std::string& from, const std::string& to) { return error_of(arm, from, to); }
};

TEST_F(BvhFile, JointsAreWhereTheAnglesPutThem) {
  const BvhMotion motion = read(arm);
  ASSERT_EQ(motion.joints.size(), 3u);
  EXPECT_EQ(motion.joints[2].name, "elbow.end");
  EXPECT_EQ(motion.frame_count(), 2);
  EXPECT_EQ(motion.frame_time, 0.04);
  EXPECT_EQ(joint_poses(motion, 0)[2].translation, Vec3(0, 3, 0));
  // The base at (10, 20, 30), turned by 90 degrees about x, carries the elbow at +z; the elbow's own turn about its z,
  // now the world's -y, takes the hand from +z to -x.
  const std::vector<RigidMotion> poses = joint_poses(motion, 1);
  EXPECT_LE((poses[0].translation - Vec3(10, 20, 30)).norm(), tolerance::rounding);
  EXPECT_LE((poses[1].translation - Vec3(10, 20, 32)).norm(), 40 * tolerance::rounding);
  EXPECT_LE((poses[2].translation - Vec3(9, 20, 32)).norm(), 40 * tolerance::rounding);
}

TEST_F(BvhFile, RotationsMultiplyInTheOrderOfTheFile) {
  std::string text = arm;
  text.replace(text.find("30 10 20 90 0 0 90 0 0"), 22,
               "0 0 0 90 90 0 0 0 0");  // about x first, then about the turned z
  const Mat3 rotation = joint_poses(read(text), 1)[0].rotation;
  Mat3 expected;  // Rx(90) Rz(90)
  expected << 0, -1, 0, 0, 0, -1, 1, 0, 0;
  EXPECT_LE((rotation - expected).cwiseAbs().maxCoeff(), tolerance::rounding);
}

TEST_F(BvhFile, PositionChannelsOfAnyJointReplaceItsOffset) {
  std::string text = arm;
  text.replace(text.find("CHANNELS 3 Z"), 12, "CHANNELS 4 Yposition Z");
  text.replace(text.find("0 0 0 0 0 0 0 0 0"), 17, "0 0 0 0 0 0 7 0 0 0");
  text.replace(text.find("30 10 20 90 0 0 90 0 0"), 22, "0 0 0 0 0 0 7 0 0 0");
  EXPECT_EQ(joint_poses(read(text), 0)[1].translation, Vec3(0, 7, 0));
}

TEST_F(BvhFile, ReadsWindowsLineEnds) {
  std::string text;
  for (const char c : arm) text += c == '\n' ? std::string("\r\n") : std::string(1, c);
  EXPECT_EQ(read(text).frame_count(), 2);
}

TEST_F(BvhFile, NamesTheLineAndTheDefectOfAMalformedFile) {
  EXPECT_THAT(error_of(""), HasSubstr("too early"));
  EXPECT_THAT(error_of("garbage\n"), AllOf(HasSubstr("motion.bvh:1: "), HasSubstr("HIERARCHY")));
  EXPECT_THAT(error_of("HIERARCHY\nMOTION\n"), AllOf(HasSubstr("motion.bvh:2: "), HasSubstr("ROOT")));
  EXPECT_THAT(error_with("JOINT", "JIONT"), AllOf(HasSubstr("motion.bvh:6: "), HasSubstr("'JIONT'")));
  EXPECT_THAT(error_with("JOINT elbow", "JOINT base"), AllOf(HasSubstr("motion.bvh:6: "), HasSubstr("second")));
  EXPECT_THAT(error_with("OFFSET 0 2 0", "OFFSET 0 2"), AllOf(HasSubstr("motion.bvh:9: "), HasSubstr("finite")));
  EXPECT_THAT(error_with("OFFSET 0 2 0", "OFFSET 0 nan 0"), AllOf(HasSubstr("motion.bvh:8: "), HasSubstr("finite")));
  EXPECT_THAT(error_with("CHANNELS 3", "CHANNELS 2"), AllOf(HasSubstr("motion.bvh:9: "), HasSubstr("Xrotation")));
  EXPECT_THAT(error_with("CHANNELS 3", "CHANNELS 7"), AllOf(HasSubstr("motion.bvh:9: "), HasSubstr("count")));
  EXPECT_THAT(error_with("Yrotation Xrotation", "Yrotation Wrotation"), HasSubstr("unknown channel 'Wrotation'"));
  EXPECT_THAT(error_with("Yrotation Xrotation", "Yrotation Yrotation"), HasSubstr("twice"));
  EXPECT_THAT(error_with("Frames: 2", "Frames: 3"), AllOf(HasSubstr("motion.bvh:20: "), HasSubstr("2 of 3")));
  EXPECT_THAT(error_with("Frames: 2", "Frames: 1"), AllOf(HasSubstr("motion.bvh:20: "), HasSubstr("more frames")));
  EXPECT_THAT(error_with("Frames: 2", "Frames: 0"), HasSubstr("no frame"));
  EXPECT_THAT(error_with("Frames: 2", "Frames: two"), HasSubstr("count"));
  EXPECT_THAT(error_with("0.04", "0"), AllOf(HasSubstr("motion.bvh:18: "), HasSubstr("positive")));
  EXPECT_THAT(error_with("0.04", "-0.04"), HasSubstr("positive"));
  EXPECT_THAT(error_with("90 0 0\n", "90 0\n"), AllOf(HasSubstr("motion.bvh:20: "), HasSubstr("8 values")));
  EXPECT_THAT(error_with("90 0 0\n", "90 0 0 0\n"), AllOf(HasSubstr("motion.bvh:20: "), HasSubstr("10 values")));
  EXPECT_THAT(error_with("90 0 0\n", "90 0 inf\n"), AllOf(HasSubstr("motion.bvh:20: "), HasSubstr("finite")));
  EXPECT_THAT(error_of(arm.substr(0, arm.find("MOTION"))), HasSubstr("too early"));
  EXPECT_THAT(error_of(arm.substr(0, arm.find("End Site"))), HasSubstr("too early"));
}

TEST_F(BvhFile, BonesOfARealClipKeepTheirLengths) {
  SKINBEM_NEEDS_SHARED_DATA("motion/cmu_02_01_walk_cm.bvh");
  const BvhMotion motion = read_bvh(testing_support::shared_data("motion/cmu_02_01_walk_cm.bvh"));
  EXPECT_EQ(motion.frame_count(), 343);
  const Index knee = motion.find("rtibia"), ankle = motion.find("rfoot");
  ASSERT_GE(knee, 0);
  ASSERT_GE(ankle, 0);
  for (Index frame = 0; frame < motion.frame_count(); frame += 10) {
    const std::vector<RigidMotion> poses = joint_poses(motion, frame);
    const double length = (poses[knee].translation - poses[ankle].translation).norm();
    EXPECT_NEAR(length, motion.joints[ankle].offset.norm(), 1e3 * tolerance::rounding);
  }
}

}  // namespace
}  // namespace skinbem
