// SPDX-License-Identifier: BSD-3-Clause
// Motions and rig of data/lower_limb as they are shipped.
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <set>

#include <skinbem/motion/bvh.hpp>
#include <skinbem/motion/rig.hpp>

#include "files.hpp"

namespace skinbem {
namespace {

using testing_support::project_file;

constexpr double gravity = 9810;          // mm/s2
constexpr double printed_digits = 0.002;  // mm: two coordinates rounded to three decimals
// Degrees between frames 10 ms apart, and the change of that from frame to frame: legs that jump turn at up to 1000
// degrees a second, and joints do not jerk.
constexpr double largest_turn = 12, largest_change_of_turn = 8;

BvhMotion motion(const std::string& name) { return read_bvh(project_file("data/lower_limb/" + name + ".bvh")); }

class LowerLimbMotion : public ::testing::TestWithParam<std::string> {};

TEST_P(LowerLimbMotion, RunsAt100HertzForSomeSeconds) {
  const BvhMotion bvh = motion(GetParam());
  EXPECT_DOUBLE_EQ(bvh.frame_time, 0.01);
  EXPECT_GE(bvh.frame_count(), 300);
}

TEST_P(LowerLimbMotion, AnglesAreSmooth) {
  const Eigen::MatrixXd& values = motion(GetParam()).values;
  const Index n = values.rows();
  const Eigen::MatrixXd turn = values.bottomRows(n - 1).rightCols(12) - values.topRows(n - 1).rightCols(12);
  EXPECT_LT(turn.cwiseAbs().maxCoeff(), largest_turn);
  EXPECT_LT((turn.bottomRows(n - 2) - turn.topRows(n - 2)).cwiseAbs().maxCoeff(), largest_change_of_turn);
}

TEST_P(LowerLimbMotion, SkeletonIsThatOfTheMesh) {
  const BvhMotion bvh = motion(GetParam());
  const Rig rig = read_rig(project_file("data/lower_limb/rig_with_toes.toml"));
  const std::vector<RigidMotion> pose = joint_poses(bvh, 0);
  for (const RigSegment& segment : rig.segments) {
    const Index proximal = bvh.find(segment.proximal_joint), distal = bvh.find(segment.distal_joint);
    ASSERT_GE(proximal, 0);
    ASSERT_GE(distal, 0);
    const auto place = [&](Index joint) { return pose[static_cast<std::size_t>(joint)].translation; };
    EXPECT_NEAR((place(distal) - place(proximal)).norm(), (segment.distal - segment.proximal).norm(), printed_digits)
        << segment.name;
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, LowerLimbMotion, ::testing::Values("walk", "jump"),
                         [](const auto& test) { return test.param; });

TEST(LowerLimbRig, CarriesEachOfThe28BonesOnce) {
  std::set<std::string> shipped;
  for (const auto& file : std::filesystem::directory_iterator(project_file("data/lower_limb/bones"))) {
    shipped.insert(bone_name(file.path().string()));
  }
  for (const char* file : {"data/lower_limb/rig.toml", "data/lower_limb/rig_with_toes.toml"}) {
    std::vector<std::string> carried;
    for (const RigSegment& segment : read_rig(project_file(file)).segments) {
      carried.insert(carried.end(), segment.bones.begin(), segment.bones.end());
    }
    EXPECT_EQ(carried.size(), 28U) << file;
    EXPECT_EQ(std::set<std::string>(carried.begin(), carried.end()), shipped) << file;
  }
}

TEST(LowerLimbWalk, EveryStrideIsTheSame) {
  const BvhMotion bvh = motion("walk");
  const Index stride = 106, frames = bvh.frame_count();
  ASSERT_GT(frames, 3 * stride);
  const Eigen::MatrixXd change = bvh.values.bottomRows(frames - stride) - bvh.values.topRows(frames - stride);
  EXPECT_LT(change.rightCols(15).cwiseAbs().maxCoeff(), 1e-3);     // angles: degrees
  EXPECT_LT(change.col(2).cwiseAbs().maxCoeff(), printed_digits);  // height
  EXPECT_LT(change.col(1).maxCoeff() - change.col(1).minCoeff(), printed_digits);
  EXPECT_NEAR(change(0, 1), -1350, 200);  // a stride of 1.2 to 1.5 m, towards -y
}

TEST(LowerLimbWalk, HipRisesAndFallsByThreeToFiveCentimetres) {
  const BvhMotion bvh = motion("walk");
  const double excursion = bvh.values.col(2).maxCoeff() - bvh.values.col(2).minCoeff();
  EXPECT_GT(excursion, 30);
  EXPECT_LT(excursion, 50);
}

TEST(LowerLimbJump, FliesUnderGravity) {
  const BvhMotion bvh = motion("jump");
  const Eigen::VectorXd height = bvh.values.col(2);
  Index top = 0;
  height.maxCoeff(&top);
  for (Index i = top - 20; i <= top + 20; ++i) {
    const double acceleration = (height(i + 1) - 2 * height(i) + height(i - 1)) / (bvh.frame_time * bvh.frame_time);
    EXPECT_NEAR(acceleration, -gravity, 2 * printed_digits / (bvh.frame_time * bvh.frame_time)) << "frame " << i;
  }
}

}  // namespace
}  // namespace skinbem
