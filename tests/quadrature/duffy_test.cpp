// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cmath>
#include <skinbem/quadrature/duffy.hpp>

#include "tolerances.hpp"

namespace skinbem {
namespace {

using Eigen::Vector3d;

const Vector3d corners[3] = {{0.1, -0.2, 0.3}, {1.2, 0.1, 0.4}, {0.3, 0.9, -0.1}};

/// The integral of 1/|y - x| over a triangle with x in a corner: from there the opposite edge is seen at the distance d
/// and between the angles a and b of its foot, and the integral is d (asinh tan b - asinh tan a).
double exact_potential(int corner) {
  const Vector3d x = corners[corner], p = corners[(corner + 1) % 3] - x, q = corners[(corner + 2) % 3] - x;
  const Vector3d along = (q - p).normalized();
  const double d = (p - p.dot(along) * along).norm();
  return d * (std::asinh(q.dot(along) / d) - std::asinh(p.dot(along) / d));
}

TEST(Duffy, IntegratesOneOverRFromEachCornerToRounding) {
  const double area = 0.5 * (corners[1] - corners[0]).cross(corners[2] - corners[0]).norm();
  for (int corner = 0; corner < 3; ++corner) {
    double sum = 0;
    for_each_duffy_point(corner, 1, 24, [&](const Vector3d& b, double weight) {
      const Vector3d y = b[0] * corners[0] + b[1] * corners[1] + b[2] * corners[2];
      sum += area * weight / (y - corners[corner]).norm();
    });
    EXPECT_NEAR(sum / exact_potential(corner), 1.0, tolerance::rounding) << corner;
  }
}

TEST(Duffy, WeightsSumToOneAndPointsLieInside) {
  double sum = 0;
  for_each_duffy_point(2, 5, 7, [&](const Vector3d& b, double weight) {
    sum += weight;
    EXPECT_GT(b.minCoeff(), 0.0);
    EXPECT_NEAR(b.sum(), 1.0, tolerance::rounding);
  });
  EXPECT_NEAR(sum, 1.0, tolerance::rounding);
}

}  // namespace
}  // namespace skinbem
