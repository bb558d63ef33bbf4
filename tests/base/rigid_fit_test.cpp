// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/base/rigid_fit.hpp>

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <cstdlib>

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

/// The textbook's answer: U diag(1, 1, det) V^T.
Mat3 rotation_by_svd(const Mat3& m) {
  const Eigen::JacobiSVD<Mat3> svd(m, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant();
  return svd.matrixU() * Vec3(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
}

TEST(NearestRotation, AgreesWithTheSingularValueDecompositionForEveryKindOfPointSet) {
  std::srand(1);
  // Singular values, signed: solid, flat, mirrored, nearly a line, equal ones, mirrored so that the answer is delicate.
  for (const Vec3& values :
       {Vec3(3, 2, 1), Vec3(3, 2, 0), Vec3(3, 2, -1), Vec3(1, 1e-3, 0), Vec3(1, 1, 1), Vec3(1, 1, 0), Vec3(1, 1, -0.9),
        Vec3(1, 0.5, -0.499), Vec3(1e-200, 1e-201, 0), Vec3(1e150, 1e149, -1e148)}) {
    for (int i = 0; i < 200; ++i) {
      const Mat3 u = Eigen::Quaterniond::UnitRandom().toRotationMatrix();
      const Mat3 v = Eigen::Quaterniond::UnitRandom().toRotationMatrix();
      const Mat3 m = u * values.asDiagonal() * v.transpose();
      const double condition = values(0) / (values(1) + values(2));
      const Mat3 q = nearest_rotation(m);
      EXPECT_LE((q - rotation_by_svd(m)).cwiseAbs().maxCoeff(), tolerance::rounding * condition) << values.transpose();
      EXPECT_LE((q * q.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff(), tolerance::rounding);
    }
  }
}

TEST(NearestRotation, IsARotationEvenWhereNoneIsDetermined) {
  const Vec3 axis(1, 2, -3);
  for (const Mat3& m : {Mat3(Mat3::Zero()), Mat3(axis * axis.transpose()), Mat3(-Mat3::Identity()),
                        Mat3(Vec3(1, 1, -1).asDiagonal())}) {
    const Mat3 q = nearest_rotation(m);
    EXPECT_LE((q * q.transpose() - Mat3::Identity()).cwiseAbs().maxCoeff(), tolerance::rounding);
    EXPECT_NEAR(q.determinant(), 1, tolerance::rounding);
  }
}

TEST(RigidFit, TakesDisplacementsInPlaceOfPositions) {
  const Points points = Points::Random(5, 3);
  const Points displacement = Points::Random(5, 3);
  const RigidMotion expected = fit_rigid(points, points + displacement);
  const RigidMotion found = fit_rigid_displacement(points, displacement);
  EXPECT_LE((found.rotation - expected.rotation).cwiseAbs().maxCoeff(), tolerance::rounding);
  EXPECT_LE((found.translation - expected.translation).cwiseAbs().maxCoeff(), tolerance::rounding);
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
