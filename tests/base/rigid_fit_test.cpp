// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/base/rigid_fit.hpp>

#include <gtest/gtest.h>

#include <Eigen/Geometry>

#include "tolerances.hpp"

namespace skinbem {
namespace {

Points moved(const Points& points, const RigidMotion& motion) {
  Points result(points.rows(), 3);
  for (Index i = 0; i < points.rows(); ++i) result.row(i) = motion(points.row(i).transpose()).transpose();
  return result;
}

TEST(RigidFit, RecoversARigidMotionOfAnyAngle) {
  const Points points = Points::Random(6, 3) * 100;
  for (const double angle : {0.0, 0.3, 1.5, 3.1, M_PI}) {
    const RigidMotion motion{Eigen::AngleAxisd(angle, Vec3(1, -2, 0.5).normalized()).toRotationMatrix(), {5, -70, 12}};
    const RigidMotion found = fit_rigid(points, moved(points, motion));
    EXPECT_LE((found.rotation - motion.rotation).cwiseAbs().maxCoeff(), tolerance::rounding);
    EXPECT_LE((found.translation - motion.translation).cwiseAbs().maxCoeff(), 200 * tolerance::rounding);
  }
}

TEST(RigidFit, NeverReflects) {
  const Points points = Points::Random(4, 3);
  const Points mirrored = points * Vec3(1, 1, -1).asDiagonal();
  EXPECT_NEAR(fit_rigid(points, mirrored).rotation.determinant(), 1, tolerance::rounding);
  Points planar = points;
  planar.col(2).setZero();
  EXPECT_NEAR(fit_rigid(planar, planar).rotation.determinant(), 1, tolerance::rounding);
}

TEST(RigidFit, MeasuresHowFarPointsAreFromALine) {
  Points line(3, 3);
  line << 0, 0, 0, 1, 2, 3, 2, 4, 6;
  EXPECT_LE(collinear_measure(line), 1e-7);
  Points square(4, 3);
  square << 0, 0, 0, 1, 0, 0, 1, 1, 0, 0, 1, 0;
  EXPECT_NEAR(collinear_measure(square), 1, tolerance::rounding);
}

}  // namespace
}  // namespace skinbem
