// SPDX-License-Identifier: BSD-3-Clause
// Kernels at a point pair: hand values, and the equations that they solve.
#include <gtest/gtest.h>

#include <functional>
#include <skinbem/kernels/kelvin.hpp>
#include <skinbem/kernels/laplace.hpp>
#include <skinbem/quadrature/gauss_legendre.hpp>

#include "tolerances.hpp"

namespace skinbem {
namespace {

using Real = long double;
using Vector = Eigen::Matrix<Real, 3, 1>;
using Block = Eigen::Matrix<Real, 3, 3>;

constexpr double kPoissons[] = {-0.5, 0.0, 0.3, 0.45, 0.49};

TEST(KelvinPoint, TakesItsHandValuesAlongAnAxis) {
  const Kelvin<double> kernel{0.25, 1.0};
  const Eigen::Vector3d x = Eigen::Vector3d::UnitX();
  const double c = 1 / (6 * pi<double>());  // 1 / (8 pi (1 - nu))

  const Eigen::Matrix3d U = kernel.single_layer(x);
  EXPECT_LE((U - Eigen::Matrix3d(Eigen::Vector3d(1.5 * c, c, c).asDiagonal())).norm(), tolerance::rounding);

  const Eigen::Matrix3d along = kernel.double_layer(x, Eigen::Vector3d::UnitX());
  EXPECT_LE((along - Eigen::Matrix3d(Eigen::Vector3d(-3.5 * c, -0.5 * c, -0.5 * c).asDiagonal())).norm(),
            tolerance::rounding);

  Eigen::Matrix3d expected = Eigen::Matrix3d::Zero();
  expected(0, 1) = 0.5 * c;
  expected(1, 0) = -0.5 * c;
  EXPECT_LE((kernel.double_layer(x, Eigen::Vector3d::UnitY()) - expected).norm(), tolerance::rounding);
}

TEST(KelvinPoint, DisplacementIsSymmetricEvenAndInverselyProportionalToShearModulusAndDistance) {
  const Eigen::Vector3d r(0.3, -1.1, 0.7);
  for (const double nu : kPoissons) {
    const Eigen::Matrix3d U = Kelvin<double>{nu, 1.0}.single_layer(r);
    EXPECT_EQ(U, U.transpose().eval());
    EXPECT_EQ(U, (Kelvin<double>{nu, 1.0}.single_layer(-r)));
    EXPECT_LE(((Kelvin<double>{nu, 4.0}.single_layer(2 * r)) * 8 - U).norm(), tolerance::rounding * U.norm());
  }
}

/// Columns: the derivatives of the displacement u_j = U_ij of the load along i.
Block gradient(const Kelvin<Real>& kernel, int i, const Vector& r) {
  const Real h = 1e-6L;
  Block derivative;
  for (int k = 0; k < 3; ++k) {
    const Vector step = h * Vector::Unit(k);
    derivative.col(k) =
        (kernel.single_layer(r + step).row(i) - kernel.single_layer(r - step).row(i)).transpose() / (2 * h);
  }
  return derivative;
}

TEST(KelvinPoint, TractionIsHookesLawOfTheDisplacement) {
  const Vector r(0.3L, -1.1L, 0.7L);
  const Vector n = Vector(1, 2, -0.5L).normalized();
  for (const double nu : kPoissons) {
    const Kelvin<Real> kernel{Real(nu), Real(2)};
    const Block T = kernel.double_layer(r, n);
    for (int i = 0; i < 3; ++i) {
      const Block derivative = gradient(kernel, i, r);
      const Block strain = (derivative + derivative.transpose()) / 2;
      const Real lambda = 2 * kernel.shear_modulus * kernel.poisson / (1 - 2 * kernel.poisson);
      const Vector traction = lambda * strain.trace() * n + 2 * kernel.shear_modulus * strain * n;
      EXPECT_LE((traction - T.row(i).transpose()).norm(), tolerance::finite_difference * T.norm()) << nu;
    }
  }
}

/// The integral of f(y, n) over the unit sphere, exact for spherical polynomials of degree 79.
Block over_unit_sphere(const std::function<Block(const Vector&)>& f) {
  const auto rule = make_gauss_legendre<Real>(40);
  const int turns = 80;
  Block sum = Block::Zero();
  for (std::size_t i = 0; i < rule.nodes.size(); ++i) {
    const Real z = 2 * rule.nodes[i] - 1, rho = std::sqrt(1 - z * z);
    for (int k = 0; k < turns; ++k) {
      const Real angle = 2 * pi<Real>() * k / turns;
      sum += f(Vector(rho * std::cos(angle), rho * std::sin(angle), z)) * (rule.weights[i] * 4 * pi<Real>() / turns);
    }
  }
  return sum;
}

TEST(KelvinPoint, TractionsOverAClosedSurfaceBalanceTheLoadInsideAndVanishOutside) {
  const Vector inside(0.2L, -0.3L, 0.1L), outside(1.5L, 2, -1);
  for (const double nu : kPoissons) {
    const Kelvin<Real> kernel{Real(nu), Real(1)};
    const auto total = [&](const Vector& x) {
      return over_unit_sphere([&](const Vector& y) { return kernel.double_layer(y - x, y); });
    };
    EXPECT_LE((total(inside) + kernel.free_term()).norm(), tolerance::rounding_of_sums) << nu;
    EXPECT_LE(total(outside).norm(), tolerance::rounding_of_sums) << nu;
  }
}

TEST(LaplacePoint, FluxIsTheNormalDerivativeAndAddsUpToTheSource) {
  const Laplace<Real> kernel;
  const Vector r(0.3L, -1.1L, 0.7L);
  const Vector n = Vector(1, 2, -0.5L).normalized();
  const Real h = 1e-6L;
  const Real slope = (kernel.single_layer(r + h * n)(0) - kernel.single_layer(r - h * n)(0)) / (2 * h);
  EXPECT_NEAR(double(slope), double(kernel.double_layer(r, n)(0)), tolerance::finite_difference);
  EXPECT_NEAR(double(kernel.single_layer(Vector(0, 2, 0))(0) * 8 * pi<Real>()), 1, tolerance::rounding);

  const auto flux = [&](const Vector& x) {
    return double(
        over_unit_sphere([&](const Vector& y) { return Block::Constant(kernel.double_layer(y - x, y)(0)); })(0));
  };
  EXPECT_NEAR(flux(Vector(0.2L, -0.3L, 0.1L)), -1, tolerance::rounding_of_sums);
  EXPECT_NEAR(flux(Vector(1.5L, 2, -1)), 0, tolerance::rounding_of_sums);
}

}  // namespace
}  // namespace skinbem
