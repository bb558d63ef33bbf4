// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <random>
#include <skinbem/kernels/panel_reach.hpp>

namespace skinbem {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

TEST(PanelReach, IsThatOfTheSingleDistances) {
  std::mt19937 random(1);
  std::uniform_real_distribution<double> uniform(-1, 1);
  for (int scene = 0; scene < 1000; ++scene) {
    PointPanel panel;
    for (std::size_t p = 0; p < kPanel; ++p) {
      panel.x[p] = uniform(random);
      panel.y[p] = uniform(random);
      panel.z[p] = uniform(random);
    }
    const Eigen::Vector3d centre(uniform(random), uniform(random), uniform(random));
    const double limit2 = 4 * std::abs(uniform(random));
    PanelMask near = 0;
    double closest2[2] = {infinity, infinity};
    for (std::size_t p = 0; p < kPanel; ++p) {
      const double distance2 = (panel.point(p) - centre).squaredNorm();
      if (distance2 < limit2) {
        near |= 1u << p;
      } else {
        double& closest = closest2[p / (kPanel / 2)];
        closest = std::min(closest, distance2);
      }
    }
    const PanelReach found = panel_reach(panel, centre, limit2);
    ASSERT_EQ(found.near, near);
    for (int half = 0; half < 2; ++half) {
      if (std::isinf(closest2[half])) {
        ASSERT_EQ(found.closest2[half], infinity);
      } else {
        ASSERT_NEAR(found.closest2[half], closest2[half], 1e-15 * 12);  // of the largest squared distance
      }
    }
  }
}

TEST(PanelReach, SaysWhereAllAreNearOrNone) {
  PointPanel panel;
  for (std::size_t p = 0; p < kPanel; ++p) {
    panel.x[p] = 1 + double(p);
    panel.y[p] = panel.z[p] = 0;
  }
  const PanelReach all = panel_reach(panel, Eigen::Vector3d::Zero(), 1e3);
  EXPECT_EQ(all.near, (1u << kPanel) - 1);
  EXPECT_EQ(all.closest2[0], infinity);
  EXPECT_EQ(all.closest2[1], infinity);
  const PanelReach none = panel_reach(panel, Eigen::Vector3d::Zero(), 1);  // as far as the limit is not near
  EXPECT_EQ(none.near, 0u);
  EXPECT_EQ(none.closest2[0], 1);
  EXPECT_EQ(none.closest2[1], std::pow(1 + kPanel / 2, 2));
}

}  // namespace
}  // namespace skinbem
