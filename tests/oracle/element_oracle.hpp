// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Element integrals in quadruple precision, by methods that share nothing with the library but the kernel's formula.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <array>
#include <boost/multiprecision/eigen.hpp>
#include <boost/multiprecision/float128.hpp>
#include <optional>
#include <skinbem/kernels/kelvin.hpp>

namespace skinbem::oracle {

/// 113 bits, 34 digits.
using Real = boost::multiprecision::float128;
using Vec3 = Eigen::Matrix<Real, 3, 1>;
using Mat3 = Eigen::Matrix<Real, 3, 3>;
using Corners = std::array<Vec3, 3>;

/// A Poisson ratio as the decimal that the double stands for, 3/10 and not the double next to it.
inline Real decimal(double nu) { return Real(static_cast<long>(nu * 1e6 + (nu < 0 ? -0.5 : 0.5))) / Real(1000000); }

/// int N_a U dS and int N_a T dS for the hats a = 0, 1, 2; T has no value for the hat of a vertex that is x.
struct Blocks {
  std::array<Mat3, 3> U;
  std::array<std::optional<Mat3>, 3> T;
};

/// * x in the triangle's plane, at a vertex or strictly inside: polar coordinates about x. The kernels are homogeneous,
/// so
///   the radial integral is elementary (R, R^2 / 2, log R: Cauchy's principal value), and composite Gauss-Legendre does
///   the line integral along the edges.
/// * else: the triangle is halved across its longest edge until each part is as far from x as it is long; 18 x 18
///   collapsed Gauss points on each.
/// Both are accurate to about 1e-20 of the largest entry. x on an edge, but not at a vertex, is not treated.
Blocks integrate_element(const Corners& corners, const Vec3& x, const Kelvin<Real>& kernel);

/// The same by the library's closed form in quadruple precision: quick, used for conditioning, and compared with the
/// above.
Blocks closed_form_element(const Corners& corners, const Vec3& x, const Kelvin<Real>& kernel);

/// The largest difference of an entry relative to the largest entry of its block, over the blocks that exist; a zero
/// block counts absolutely.
Real difference_U(const Blocks& a, const Blocks& exact);
Real difference_T(const Blocks& a, const Blocks& exact);

/// Distance from x to the triangle.
double distance_to_triangle(const std::array<Eigen::Vector3d, 3>& corners, const Eigen::Vector3d& x);

}  // namespace skinbem::oracle
