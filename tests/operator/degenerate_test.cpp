// SPDX-License-Identifier: BSD-3-Clause
// Points and triangles at the edge of what a double holds.
#include <gtest/gtest.h>

#include <skinbem/base/types.hpp>
#include <skinbem/kernels/kelvin.hpp>
#include <skinbem/operator/element_integral.hpp>

namespace skinbem {
namespace {

using Integral = ElementIntegral<Kelvin<double>>;

TEST(DegenerateInput, IntegralsAreFiniteForAnyPointAndUpToAspect1e6) {
  const Integral integral({0.3, 1.0}, 1e-8);
  for (const double aspect : {1.0, 1e3, 1e6}) {
    for (const double scale : {1e-12, 1.0, 1e12}) {
      const Vec3 a(0, 0, 0), b(scale, 0, 0), c(0.3 * scale, scale / aspect, 0);
      const SourceTriangle triangle(a, b, c);
      for (const Vec3& base : {a, b, c, Vec3((a + b) / 2), Vec3((a + b + c) / 3)}) {
        for (const double distance : {0.0, 1e-300, 1e-160, 1e-60, 1e-20, 1e-8, 1.0, 1e6}) {
          for (const Vec3& direction : {Vec3(0, 0, 1), Vec3(1, 0, 0), Vec3(0, -1, 0), Vec3(0.5, 0.5, -0.7)}) {
            const Vec3 x = base + direction * distance * scale;
            for (const auto& blocks : {integral.single_layer(triangle, x), integral.double_layer(triangle, x)}) {
              for (const auto& block : blocks) EXPECT_TRUE(block.allFinite()) << aspect << ' ' << x.transpose();
            }
          }
        }
      }
    }
  }
}

TEST(DegenerateInput, APointAtAVertexAndOneThatTouchesItAgree) {
  const Integral integral({0.3, 1.0}, 1e-12);
  const SourceTriangle triangle({0, 0, 0}, {1, 0, 0}, {0.3, 0.8, 0});
  const auto at = integral.double_layer(triangle, {0, 0, 0}), close = integral.double_layer(triangle, {0, 0, 1e-300});
  for (int v = 1; v < 3; ++v) EXPECT_EQ(at[v], close[v]);
}

}  // namespace
}  // namespace skinbem
