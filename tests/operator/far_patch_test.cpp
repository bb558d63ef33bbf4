// SPDX-License-Identifier: BSD-3-Clause
// A patch's sources against the few that stand for them from afar.
#include <gtest/gtest.h>

#include <random>
#include <skinbem/kernels/kelvin.hpp>
#include <skinbem/kernels/laplace.hpp>
#include <skinbem/operator/collocation.hpp>
#include <skinbem/operator/far_patch.hpp>

#include "meshes.hpp"

namespace skinbem {
namespace {

using namespace testing_support;

/// Random sources in a box around (0.3, -0.2, 0.1), weights positive.
struct Sources {
  std::vector<double> x, y, z, weights[3];
  Eigen::AlignedBox3d box;

  Sources(const Vec3& half, std::size_t count) {
    std::mt19937 random(2);
    std::uniform_real_distribution<double> uniform(-1, 1);
    const Vec3 centre(0.3, -0.2, 0.1);
    box = Eigen::AlignedBox3d(Vec3(centre - half), Vec3(centre + half));
    for (std::size_t q = 0; q < count; ++q) {
      const Vec3 place = centre + half.cwiseProduct(Vec3(uniform(random), uniform(random), uniform(random)));
      x.push_back(place[0]);
      y.push_back(place[1]);
      z.push_back(place[2]);
      for (auto& w : weights) w.push_back(std::abs(uniform(random)));
    }
  }
  SourcePoints points() const {
    return {x.size(), x.data(), y.data(), z.data(), {weights[0].data(), weights[1].data(), weights[2].data()}};
  }
};

template <class Kernel>
typename Kernel::Block field(const Kernel& kernel, const SourcePoints& sources, const Vec3& at) {
  typename Kernel::Block sum = Kernel::Block::Zero();
  for (std::size_t q = 0; q < sources.count; ++q) {
    const double weight = sources.weights[0][q] + sources.weights[1][q] + sources.weights[2][q];
    sum += weight * kernel.single_layer(Vec3(sources.x[q], sources.y[q], sources.z[q]) - at);
  }
  return sum;
}

template <class Kernel>
void expect_alike(const Kernel& kernel, const Vec3& half, double tolerance) {
  const Sources sources(half, 50);
  detail::FarPatch far(sources.box, tolerance);
  far.add(sources.points());
  std::mt19937 random(5);
  std::normal_distribution<double> normal;
  for (int k = 0; k < 300; ++k) {
    const Vec3 direction = Vec3(normal(random), normal(random), normal(random)).normalized();
    const double distance = far.radius() * detail::FarPatch::separation * (k % 3 == 0 ? 20 : 1.0001);
    const Vec3 at = sources.box.center() + distance * direction;
    const auto expected = field(kernel, sources.points(), at), found = field(kernel, far.points(), at);
    ASSERT_LE((found - expected).cwiseAbs().maxCoeff(), tolerance * expected.cwiseAbs().maxCoeff())
        << half.transpose() << ", " << far.size() << " nodes";
  }
}

TEST(FarPatch, ActsAsItsSourcesToTheTolerance) {
  for (const Vec3& half : {Vec3(1, 1, 1), Vec3(1, 1, 0.1), Vec3(0.3, 2, 0.01), Vec3(1, 1, 0), Vec3(1, 0, 0)}) {
    for (const double tolerance : {1e-1, 1e-2, 1e-4, 1e-6, 1e-9, 1e-12}) {
      expect_alike(Kelvin<double>{0.45, 1.0}, half, tolerance);
      expect_alike(Kelvin<double>{-0.5, 1.0}, half, tolerance);
      expect_alike(Laplace<double>{}, half, tolerance);
    }
  }
}

TEST(FarPatch, ServesPanelsThatAreFarThroughout) {
  const detail::FarPatch far(Eigen::AlignedBox3d(Vec3(-1, -1, -1), Vec3(1, 1, 1)), 1e-3);
  const double limit = detail::FarPatch::separation * far.radius();
  const std::vector<Vec3> vertices = {Vec3(1.001 * limit, 0, 0), Vec3(0, -2 * limit, 0), Vec3(0, 0, 0.999 * limit)};
  const std::vector<std::int32_t> two = {0, 1}, three = {0, 1, 2};
  EXPECT_TRUE(far.serves(detail::RowPanel(vertices, two)));
  EXPECT_FALSE(far.serves(detail::RowPanel(vertices, three)));
}

/// A patch of a tenth of a fine skin, near and far from it, against the same at a tighter tolerance.
TEST(FarPatch, KeepsTheColumnsOfALargePatchWithinTheTolerance) {
  const TriangleMesh mesh = ellipsoid(5, {1, 0.3, 0.3});
  std::vector<VertexWeight> density;
  for (std::int32_t v = 0; v < mesh.vertex_count(); ++v) {
    const double weight = mesh.vertices(v, 0) - 0.85;
    if (weight > 0) density.push_back({v, weight});
  }
  ASSERT_GT(density.size(), 300u);
  const Kelvin<double> kernel{0.45, 1.0};
  const Eigen::MatrixXd exact = Collocation<Kelvin<double>>(mesh, kernel, {1e-11}).single_layer_columns(density);
  for (const double tolerance : {1e-2, 1e-4, 1e-6, 1e-8}) {
    const Eigen::MatrixXd G = Collocation<Kelvin<double>>(mesh, kernel, {tolerance}).single_layer_columns(density);
    for (Index k = 0; k < mesh.vertex_count(); ++k) {
      const Mat3 found = G.middleRows<3>(3 * k), expected = exact.middleRows<3>(3 * k);
      ASSERT_LE((found - expected).cwiseAbs().maxCoeff(), tolerance * expected.cwiseAbs().maxCoeff()) << tolerance;
    }
  }
}

}  // namespace
}  // namespace skinbem
