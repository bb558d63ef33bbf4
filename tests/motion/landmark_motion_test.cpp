// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/motion/landmark_motion.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <numbers>

#include "files.hpp"
#include "refusal.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing_support::refusal;

const Vec3 knee(3, -2, 430), ankle(-5, 8, 80), toes(-20, -110, 25);

/// A shank and a foot with mesh axes z up, -y forward; the motion file has y up, z forward.
Rig leg_rig() {
  Rig rig;
  rig.path = "leg.toml";
  rig.axes << 1, 0, 0, 0, 0, -1, 0, 1, 0;
  rig.scale_segment = "shank";
  RigSegment shank{"shank", -1, {"tibia"}, {}, knee, knee, ankle, {1, 0.1, 0}, "Leg", "Foot", {1, 0, 0}, {}};
  RigSegment foot{"foot", 0, {"talus"}, {}, ankle, ankle, toes, {1, 0.1, 0}, "Foot", "Toe", {1, 0, 0}, {}};
  rig.segments = {shank, foot};
  return rig;
}

/// Joints Leg, Foot, Toe whose zero pose has the given offsets; all have six channels, x, y, z positions first.
BvhMotion leg_file(const Vec3& shank_offset, const Vec3& foot_offset, Index frames) {
  BvhMotion motion;
  motion.frame_time = 0.01;
  const std::vector<BvhChannel> rotations = {BvhChannel::z_rotation, BvhChannel::y_rotation, BvhChannel::x_rotation};
  const std::vector<BvhChannel> all = {BvhChannel::x_position, BvhChannel::y_position, BvhChannel::z_position,
                                       BvhChannel::z_rotation, BvhChannel::y_rotation, BvhChannel::x_rotation};
  motion.joints = {{"Leg", -1, Vec3::Zero(), all, 0},
                   {"Foot", 0, shank_offset, rotations, 6},
                   {"Toe", 1, foot_offset, rotations, 9}};
  motion.values = Eigen::MatrixXd::Zero(frames, 12);
  return motion;
}

struct Marks {
  std::vector<Landmark> landmarks;
  Points positions;
};

Marks leg_landmarks() {
  Marks marks;
  for (const char* name : {"LE", "LM", "5H"}) {
    Landmark landmark;
    landmark.name = name;
    landmark.bone = landmark.name == "5H" ? "bones/talus.obj" : "bones/tibia.obj";
    marks.landmarks.push_back(landmark);
  }
  marks.positions.resize(3, 3);
  marks.positions << -40, -2, 430, -45, 8, 80, -60, -100, 20;
  for (Index k = 0; k < 3; ++k) {
    marks.landmarks[k].bone_point = marks.positions.row(k).transpose() + Vec3(20, 1, -3);
  }
  return marks;
}

double angle(const Mat3& rotation) { return Eigen::AngleAxisd(rotation).angle() * 180 / std::numbers::pi; }

TEST(MotionByJoints, BonesThatMoveAsOneBodyCarryTheLandmarksAsThatBody) {
  BvhMotion file = leg_file({0, -30, 0}, {0, -5, 11}, 40);
  for (Index f = 0; f < 40; ++f) {
    const double t = static_cast<double>(f);
    file.values.row(f).head(6) << t, 50, 2 * t, 9 * t, 4 * t, -5 * t;  // to 351 degrees
  }
  const Rig rig = leg_rig();
  const Marks marks = leg_landmarks();
  const LandmarkMotion motion = landmark_motion(rig, move_by_joints(rig, file), marks.landmarks, marks.positions);

  const RigidMotion rest = motion.skeleton.segments[0][0];  // both segments move from frame to frame as the root does
  const RigidMotion foot_rest = motion.skeleton.segments[0][1];
  for (Index f = 0; f < 40; ++f) {
    const RigidMotion root = motion.skeleton.segments[f][0] * rest.inverse();
    const RigidMotion foot = motion.skeleton.segments[f][1] * foot_rest.inverse();
    EXPECT_LE((root.rotation - foot.rotation).cwiseAbs().maxCoeff(), tolerance::motion);
    for (Index k = 0; k < 3; ++k) {
      const Vec3 p = marks.positions.row(k).transpose();
      const Vec3 first = p + motion.displacements.row(0).segment<3>(3 * k).transpose();
      const Vec3 now = p + motion.displacements.row(f).segment<3>(3 * k).transpose();
      EXPECT_LE((root(first) - now).norm(), 1e3 * tolerance::motion) << "frame " << f << ", coordinates of size 1000";
    }
  }
}

TEST(MotionByJoints, ALegThatStandsAsInTheMeshDoesNotMove) {
  // The file's zero pose is the mesh's own pose in the file's axes, at half the size.
  const Rig rig = leg_rig();
  const Mat3 back = rig.axes.transpose();
  BvhMotion file = leg_file(0.5 * (back * (ankle - knee)), 0.5 * (back * (toes - ankle)), 2);
  Rig same = rig;
  for (RigSegment& segment : same.segments) segment.motion_axis = (back * segment.axis).normalized();
  for (Index f = 0; f < 2; ++f) file.values.row(f).head<3>() = 0.5 * (back * knee).transpose();
  const Marks marks = leg_landmarks();
  const LandmarkMotion motion = landmark_motion(same, move_by_joints(same, file), marks.landmarks, marks.positions);
  EXPECT_LE(motion.displacements.cwiseAbs().maxCoeff(), 1e3 * tolerance::motion);
}

TEST(MotionByJoints, TheRestPoseOfTheFileIsNotTrusted) {
  // Two files of the same motion: legs straight down at angles 0, and splayed by 20 degrees, turned back by the
  // channels.
  BvhMotion straight = leg_file({0, -30, 0}, {0, -5, 11}, 30), splayed = straight;
  const Mat3 splay = Eigen::AngleAxisd(-20 * std::numbers::pi / 180, Vec3::UnitZ()).toRotationMatrix();
  splayed.joints[1].offset = splay * straight.joints[1].offset;
  splayed.joints[2].offset = splay * straight.joints[2].offset;
  Rig rig = leg_rig(), splayed_rig = rig;
  for (RigSegment& segment : splayed_rig.segments) segment.motion_axis = splay * segment.motion_axis;
  for (Index f = 0; f < 30; ++f) {
    const double bend = 2.0 * static_cast<double>(f);
    straight.values.row(f).tail<9>() << 0, 0, bend, 0, 0, -bend, 0, 0, 0;
    // The same world rotations in joints whose zero axes are splayed: W' = W splay^T.
    const Mat3 turn = Eigen::AngleAxisd(bend * std::numbers::pi / 180, Vec3::UnitX()).toRotationMatrix();
    const Vec3 leg = (turn * splay.transpose()).eulerAngles(2, 1, 0) * 180 / std::numbers::pi;
    const Vec3 foot = (splay * turn.transpose() * splay.transpose()).eulerAngles(2, 1, 0) * 180 / std::numbers::pi;
    splayed.values.row(f).tail<9>() << leg.transpose(), foot.transpose(), 0, 0, 0;
  }
  const Marks marks = leg_landmarks();
  const auto moved = [&](const Rig& r, const BvhMotion& file) {
    return landmark_motion(r, move_by_joints(r, file), marks.landmarks, marks.positions).displacements;
  };
  EXPECT_LE((moved(rig, straight) - moved(splayed_rig, splayed)).cwiseAbs().maxCoeff(), 1e3 * tolerance::motion);
}

TEST(MotionByJoints, HeightsAndStepsAreScaledByTheShank) {
  BvhMotion file = leg_file({0, -30, 0}, {0, -5, 11}, 2);
  file.values.row(0).head<3>() << 7, 40, -3;
  file.values.row(1).head<3>() << 7, 45, 17;  // 5 up, 20 forward
  Rig rig = leg_rig();
  rig.mesh_floor = -10;
  const double scale = (knee - ankle).norm() / 30;
  const SkeletonMotion motion = move_by_joints(rig, file);
  EXPECT_LE((motion.segments[0][0](knee) - Vec3(3, -2, -10 + 40 * scale)).norm(), 1e3 * tolerance::motion);
  const Vec3 step = motion.segments[1][0](knee) - motion.segments[0][0](knee);
  EXPECT_LE((step - scale * Vec3(0, -20, 5)).norm(), 1e3 * tolerance::motion);
}

TEST(MotionByJoints, SaysWhichJointIsNotInTheFile) {
  Rig rig = leg_rig();
  rig.segments[1].distal_joint = "Toes";
  const BvhMotion file = leg_file({0, -30, 0}, {0, -5, 11}, 1);
  EXPECT_THAT(refusal([&] { move_by_joints(rig, file); }),
              AllOf(HasSubstr("leg.toml"), HasSubstr("'foot'"), HasSubstr("'Toes'"), HasSubstr("Leg Foot Toe")));
  rig = leg_rig();
  rig.segments[0].motion_axis = Vec3(0, 1, 0);
  EXPECT_THAT(refusal([&] { move_by_joints(rig, file); }), HasSubstr("motion_axis"));
}

TEST(Resampling, KeepsJointsTogetherAndFramesOfTheFile) {
  BvhMotion file = leg_file({0, -30, 0}, {0, -5, 11}, 11);
  for (Index f = 0; f < 11; ++f) {
    const double t = static_cast<double>(f);
    file.values.row(f) << t, 40, 3 * t, 0, 0, 9 * t, 0, 0, -12 * t, 0, 0, 0;
  }
  const Rig rig = leg_rig();
  const SkeletonMotion motion = move_by_joints(rig, file);
  const SkeletonMotion finer = resampled(motion, 240);
  EXPECT_EQ(finer.frame_count(), 25);
  for (const std::vector<RigidMotion>& frame : finer.segments) {
    EXPECT_LE((frame[0](ankle) - frame[1](ankle)).norm(), 1e3 * tolerance::motion);
  }
  EXPECT_LE((finer.segments[12][1].rotation - motion.segments[5][1].rotation).norm(), tolerance::motion);
  const Mat3 half = finer.segments[6][0].rotation * motion.segments[2][0].rotation.transpose();
  EXPECT_NEAR(angle(half), 4.5, 1e-9);  // 6 / 240 s lies midway between the frames 2 and 3
  const SkeletonMotion part = resampled(motion, 0, 0.02, 0.05);
  EXPECT_EQ(part.frame_count(), 4);
  EXPECT_EQ(part.first_time, 0.02);
  EXPECT_EQ(part.segments[0][0].translation, motion.segments[2][0].translation);
  EXPECT_THROW(resampled(motion, 0, 0.5, 0.6), Error);
  for (const double too_many : {1e9, 1e300}) EXPECT_THROW(resampled(motion, too_many), Error);
}

class Modes : public ::testing::Test {
 protected:
  Modes() : rig(leg_rig()), file(leg_file({0, -30, 0}, {0, -5, 11}, 3)), marks(leg_landmarks()) {
    for (Index f = 0; f < 3; ++f) {
      const double t = static_cast<double>(f);
      file.values.row(f).head(6) << t, 40, 0, 0, 0, 10 * t;
    }
  }
  LandmarkMotion run(MotionMode mode, const ArtefactOptions& artefact = {}) {
    return landmark_motion(rig, move_by_joints(rig, file), marks.landmarks, marks.positions, mode, artefact);
  }
  static SkeletonMotion at_rest(const Rig& rig) {
    SkeletonMotion skeleton = skeleton_of(rig, 100, 0);
    skeleton.segments = {{RigidMotion(), RigidMotion()}};
    return skeleton;
  }
  Rig rig;
  BvhMotion file;
  Marks marks;
};

TEST_F(Modes, FollowIsZeroAtRestAndLiteralIsTheOffsetFromTheBonePoint) {
  ArtefactOptions artefact;
  artefact.kind = ArtefactKind::trial;
  const auto rest = [&](MotionMode mode, const ArtefactOptions& options) {
    return landmark_motion(rig, at_rest(rig), marks.landmarks, marks.positions, mode, options).displacements;
  };
  EXPECT_EQ(rest(MotionMode::follow, artefact).cwiseAbs().maxCoeff(), 0);
  const Eigen::MatrixXd literal = rest(MotionMode::literal, {});
  for (Index k = 0; k < 3; ++k) {
    EXPECT_LE((literal.row(0).segment<3>(3 * k).transpose() - Vec3(-20, -1, 3)).norm(), 1e3 * tolerance::rounding);
  }
}

TEST_F(Modes, TheArtefactLiesAlongGWithTheLengthThatWasDrawn) {
  ArtefactOptions artefact;
  artefact.kind = ArtefactKind::frame;
  for (const MotionMode mode : {MotionMode::follow, MotionMode::literal}) {
    const Eigen::MatrixXd G = run(mode).displacements, u = run(mode, artefact).displacements;
    for (Index f = 0; f < 3; ++f) {
      for (Index k = 0; k < 3; ++k) {
        const Vec3 g = G.row(f).segment<3>(3 * k).transpose();
        const double L = artefact_length(artefact, k, f, 0.01 * static_cast<double>(f));
        const double size = mode == MotionMode::literal ? g.norm() : std::sqrt(g.squaredNorm() + 25);
        const Vec3 slide = u.row(f).segment<3>(3 * k).transpose() - g;
        EXPECT_LE((slide - L / size * g).norm(), 1e3 * tolerance::motion);
      }
    }
  }
}

TEST_F(Modes, TheSameSeedGivesTheSameBits) {
  for (const ArtefactKind kind : {ArtefactKind::trial, ArtefactKind::correlated, ArtefactKind::frame}) {
    ArtefactOptions artefact;
    artefact.kind = kind;
    const Eigen::MatrixXd first = run(MotionMode::follow, artefact).displacements;
    EXPECT_TRUE(first == run(MotionMode::follow, artefact).displacements);
    artefact.seed = 2;
    EXPECT_FALSE(first == run(MotionMode::follow, artefact).displacements);
  }
}

TEST_F(Modes, SayWhatIsMissing) {
  marks.landmarks[1].bone_point.reset();
  EXPECT_THAT(refusal([&] { run(MotionMode::literal); }), AllOf(HasSubstr("'LM'"), HasSubstr("bone_x")));
  EXPECT_THAT(refusal([&] { run(MotionMode::markers); }), HasSubstr("TRC"));
  marks.landmarks[2].bone = "femur";
  EXPECT_THAT(refusal([&] { run(MotionMode::follow); }), AllOf(HasSubstr("'5H'"), HasSubstr("'femur'")));
  rig.segments[1].landmarks = {"5H"};  // the rig's list wins over the bone
  EXPECT_EQ(run(MotionMode::follow).segments, (std::vector<Index>{0, 0, 1}));
  rig.segments[1].landmarks = {"5H", "1H"};
  EXPECT_THAT(refusal([&] { run(MotionMode::follow); }), AllOf(HasSubstr("leg.toml"), HasSubstr("'1H'")));
}

TEST(RealLeg, WalksAndJumpsWithTheClipsOfCmu) {
  const Rig rig = read_rig(testing_support::project_file("data/rigs/real_leg_cmu.toml"));
  const Vec3 mesh_ankle = rig.segments[1].joint;
  for (const char* clip : {"motion/cmu_02_01_walk_cm.bvh", "motion/cmu_02_04_jump.bvh"}) {
    SKINBEM_NEEDS_SHARED_DATA(clip);
    const SkeletonMotion motion = read_skeleton_motion(rig, testing_support::shared_data(clip));
    for (Index f = 0; f < motion.frame_count(); ++f) {
      const RigidMotion &shank = motion.segments[f][0], &foot = motion.segments[f][1];
      EXPECT_LE((shank(mesh_ankle) - foot(mesh_ankle)).norm(), 1e4 * tolerance::motion);
      EXPECT_LE(angle(shank.rotation.transpose() * foot.rotation), 37);
      EXPECT_GT(shank(rig.segments[0].proximal).z(), shank(mesh_ankle).z() + 100) << "the knee is above the ankle";
      const Vec3 toes_at_shank = shank.inverse()(foot(rig.segments[1].distal));
      EXPECT_LT(toes_at_shank.y(), mesh_ankle.y() - 60) << "the toes point forward";
      const Index before = std::max<Index>(f - 1, 0);
      EXPECT_LE((foot(mesh_ankle) - motion.segments[before][1](mesh_ankle)).norm(), 40) << "no leap";
    }
  }
}

}  // namespace
}  // namespace skinbem
