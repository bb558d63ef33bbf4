// SPDX-License-Identifier: BSD-3-Clause
#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <limits>

#include <skinbem/base/rigid_fit.hpp>
#include <skinbem/motion/landmark_motion.hpp>

#include "files.hpp"
#include "refusal.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using ::testing::AllOf;
using ::testing::HasSubstr;
using testing_support::refusal;

constexpr double not_seen = std::numeric_limits<double>::quiet_NaN();

/// Four markers of one shank in a laboratory of y up, 1.2 times the size of the mesh (z up, -y forward).
struct Laboratory {
  Rig rig;
  TrcMotion file;
  Points mesh{4, 3};
  std::vector<RigidMotion> moves;  // of the shank, in the laboratory

  Laboratory() {
    mesh << 10, 0, 400, -30, 20, 250, 25, -15, 120, 0, 40, 300;
    rig.path = "leg.toml";
    rig.format = MotionFormat::trc;
    rig.axes << 1, 0, 0, 0, 0, -1, 0, 1, 0;
    rig.chained = true;
    RigSegment shank;
    shank.name = "shank";
    shank.bones = {"tibia"};
    shank.joint = Vec3(0, 0, 430);
    for (const char* name : {"A", "B", "C", "D"}) {
      shank.markers.push_back(name);
      file.markers.push_back(name);
      rig.placement.push_back({std::string(name), mesh.row(std::ssize(file.markers) - 1).transpose()});
    }
    rig.segments = {shank};
    file.rate = 50;
    file.positions.resize(20, 12);
    for (Index f = 0; f < 20; ++f) {
      const double t = static_cast<double>(f);
      const Eigen::AngleAxisd turn(0.1 * t, Vec3(1, 2, -0.5).normalized());
      moves.push_back({turn.toRotationMatrix(), Vec3(t, 2 * t, -5 * t)});
      for (Index m = 0; m < 4; ++m) {
        const Vec3 rest = 1.2 * (rig.axes.transpose() * mesh.row(m).transpose()) + Vec3(100, 0, 300);
        file.positions.row(f).segment<3>(3 * m) = moves.back()(rest).transpose();
      }
    }
  }
};

TEST(MotionByMarkers, AMarkerOnTheMeshGoesWhereItWasMeasured) {
  const Laboratory lab;
  const SkeletonMotion motion = move_by_markers(lab.rig, lab.file);
  for (Index f = 0; f < 20; ++f) {
    const RigidMotion& shank = motion.segments[f][0];
    for (Index m = 0; m < 4; ++m) {
      const Vec3 was = motion.segments[0][0](lab.mesh.row(m).transpose()), is = shank(lab.mesh.row(m).transpose());
      const Vec3 measured = (lab.file.positions.row(f) - lab.file.positions.row(0)).segment<3>(3 * m).transpose();
      EXPECT_LE((is - was - lab.rig.axes * measured / 1.2).norm(), 1e3 * tolerance::motion);
    }
  }
  EXPECT_LE((motion.segments[0][0].rotation - Mat3::Identity()).norm(), tolerance::motion)
      << "the rest frame is the first";
}

TEST(MotionByMarkers, ThreeSeenMarkersSufficeAndShortGapsAreBridged) {
  const Laboratory whole;
  Laboratory lab;
  lab.file.positions.row(4).segment<3>(3).setConstant(not_seen);
  lab.file.positions.row(9).head<9>().setConstant(not_seen);
  const SkeletonMotion expected = move_by_markers(whole.rig, whole.file), motion = move_by_markers(lab.rig, lab.file);
  EXPECT_LE((motion.segments[4][0].translation - expected.segments[4][0].translation).norm(), 1e3 * tolerance::motion);
  EXPECT_LE((motion.segments[9][0].rotation - expected.segments[9][0].rotation).norm(), tolerance::motion)
      << "a steady turn is bridged exactly";
}

TEST(MotionByMarkers, LongGapsAndGapsAtTheEndsAreErrors) {
  Laboratory lab;
  lab.file.positions.block(3, 0, 12, 6).setConstant(not_seen);
  EXPECT_THAT(refusal([&] { move_by_markers(lab.rig, lab.file); }), AllOf(HasSubstr("'shank'"), HasSubstr("0.06")));
  lab = Laboratory();
  lab.file.positions.bottomLeftCorner(1, 6).setConstant(not_seen);
  EXPECT_THAT(refusal([&] { move_by_markers(lab.rig, lab.file); }), HasSubstr("0.38"));
  lab = Laboratory();
  lab.file.positions.topLeftCorner(1, 3).setConstant(not_seen);
  EXPECT_THAT(refusal([&] { move_by_markers(lab.rig, lab.file); }), AllOf(HasSubstr("'A'"), HasSubstr("rest frame")));
}

TEST(MotionByMarkers, SaysWhatDoesNotFitTheFile) {
  Laboratory lab;
  lab.rig.segments[0].markers[2] = "E";
  EXPECT_THAT(refusal([&] { move_by_markers(lab.rig, lab.file); }), AllOf(HasSubstr("'E'"), HasSubstr("A B C D")));
  lab = Laboratory();
  lab.rig.rest_time = 7;
  EXPECT_THAT(refusal([&] { move_by_markers(lab.rig, lab.file); }), HasSubstr("rest_time"));
  lab = Laboratory();
  std::swap(lab.rig.placement[0].mesh, lab.rig.placement[2].mesh);
  EXPECT_THAT(refusal([&] { move_by_markers(lab.rig, lab.file); }), HasSubstr("[placement]"));
}

TEST(MotionByMarkers, AMarkerOnTheSkinMovesItsLandmarkItself) {
  Laboratory lab;
  lab.file.positions(7, 1) += 12;  // the skin slides by 10 mm of the mesh, upwards
  lab.rig.skin_markers["P"] = "A";
  Landmark marked, unmarked;
  marked.name = "P";
  unmarked.name = "Q";
  marked.bone = unmarked.bone = "tibia";
  const Points positions = lab.mesh.topRows(2);
  const LandmarkMotion motion =
      landmark_motion(lab.rig, move_by_markers(lab.rig, lab.file), {marked, unmarked}, positions, MotionMode::markers);
  EXPECT_EQ(motion.unmarked, std::vector<std::string>{"Q"});
  const Vec3 measured = (lab.file.positions.row(7) - lab.file.positions.row(0)).head<3>().transpose();
  EXPECT_LE((motion.displacements.row(7).head<3>().transpose() - motion.displacements.row(0).head<3>().transpose() -
             lab.rig.axes * measured / 1.2)
                .norm(),
            1e3 * tolerance::motion);
}

TEST(RealLeg, FollowsTheMarkersOfOpenSim) {
  SKINBEM_NEEDS_SHARED_DATA("motion/subject01_walk1.trc");
  const TrcMotion file = read_trc(testing_support::shared_data("motion/subject01_walk1.trc"));
  EXPECT_EQ(file.frame_count(), 151);
  EXPECT_EQ(file.markers.size(), 41u);
  const Rig rig = read_rig(testing_support::project_file("data/rigs/real_leg_opensim.toml"));
  const Index rest_frame = 49;
  for (const RigSegment& segment : rig.segments) {
    Points rest(std::ssize(segment.markers), 3), now = rest;
    double worst = 0;
    for (Index f = 0; f < file.frame_count(); ++f) {
      for (Index i = 0; i < rest.rows(); ++i) {
        rest.row(i) = file.position(rest_frame, file.find(segment.markers[i])).value().transpose();
        now.row(i) = file.position(f, file.find(segment.markers[i])).value().transpose();
      }
      const RigidMotion fit = fit_rigid(rest, now);
      for (Index i = 0; i < rest.rows(); ++i)
        worst = std::max(worst, (fit(rest.row(i).transpose()) - now.row(i).transpose()).norm());
    }
    EXPECT_LE(worst, 6) << segment.name << ": plates and shoe are rigid to some millimetres";
  }
  const SkeletonMotion motion = move_by_markers(rig, file);
  const Vec3 knee = rig.segments[0].joint, ankle = rig.segments[1].joint;
  EXPECT_LE(std::acos(motion.segments[rest_frame][0].rotation(2, 2)), 0.1) << "the shank stands at rest";
  for (Index f = 0; f < motion.frame_count(); ++f) {
    const RigidMotion &shank = motion.segments[f][0], &foot = motion.segments[f][1];
    EXPECT_LE((shank(ankle) - foot(ankle)).norm(), 1e3 * tolerance::motion);
    EXPECT_GT(shank(knee).z(), shank(ankle).z() + 100);
    EXPECT_LE(Eigen::AngleAxisd(shank.rotation.transpose() * foot.rotation).angle(), 0.35);
    EXPECT_LT(shank.inverse()(foot(ankle + Vec3(0, -100, -30))).y(), ankle.y() - 60) << "the toes point forward";
  }
}

}  // namespace
}  // namespace skinbem
