// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Signs of determinants of coordinates: in double where the rounding bound allows, else with 113 bits. What is lost in
/// those too is zero: points on a regular grid are in one plane exactly, and must be seen so.
#pragma once

#include <cmath>

#include <skinbem/base/types.hpp>

namespace skinbem {

#if defined(__SIZEOF_FLOAT128__)
__extension__ typedef __float128 WideFloat;
inline constexpr double wide_unit = 0x1p-113;
#else
typedef long double WideFloat;
inline constexpr double wide_unit = 0x1p-64;
#endif

inline int sign(auto x) { return x > 0 ? 1 : (x < 0 ? -1 : 0); }

namespace detail {

template <class Real>
struct Det3 {
  Real value, permanent;  ///< the permanent of absolute values bounds the rounding
};

template <class Real>
Det3<Real> orientation_determinant(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  const auto minus_d = [&](const Vec3& p, int i) { return static_cast<Real>(p(i)) - static_cast<Real>(d(i)); };
  const Real ax = minus_d(a, 0), ay = minus_d(a, 1), az = minus_d(a, 2);
  const Real bx = minus_d(b, 0), by = minus_d(b, 1), bz = minus_d(b, 2);
  const Real cx = minus_d(c, 0), cy = minus_d(c, 1), cz = minus_d(c, 2);
  const auto size = [](Real x) { return x < 0 ? -x : x; };
  const Real bc = bx * cy, cb = cx * by, ca = cx * ay, ac = ax * cy, ab = ax * by, ba = bx * ay;
  return {az * (bc - cb) + bz * (ca - ac) + cz * (ab - ba),
          size(az) * (size(bc) + size(cb)) + size(bz) * (size(ca) + size(ac)) + size(cz) * (size(ab) + size(ba))};
}

}  // namespace detail

/// 1 when `d` lies below the plane of a, b, c, which look counter-clockwise from above; -1 above; 0 in it (as far as
/// 113 bits tell). The bound of the double evaluation is that of J. R. Shewchuk, Adaptive Precision Floating-Point
/// Arithmetic and Fast Robust Geometric Predicates, Discrete & Computational Geometry 18 (1997), table of stage A.
inline int orientation(const Vec3& a, const Vec3& b, const Vec3& c, const Vec3& d) {
  constexpr double bound = 7.8e-16;  // (7 + 56 e) e with e = 2^-53
  const auto quick = detail::orientation_determinant<double>(a, b, c, d);
  if (std::abs(quick.value) > bound * quick.permanent) return sign(quick.value);
  if (quick.permanent == 0) return 0;
  const auto careful = detail::orientation_determinant<WideFloat>(a, b, c, d);
  const WideFloat lost = 8 * wide_unit * careful.permanent;
  return careful.value > lost ? 1 : (careful.value < -lost ? -1 : 0);
}

/// 1 when a, b, c turn counter-clockwise in the coordinates (u, v); -1 clockwise; 0 on a line. Bound: the same source.
inline int orientation_2d(const Vec3& a, const Vec3& b, const Vec3& c, int u, int v) {
  constexpr double bound = 3.4e-16;  // (3 + 16 e) e
  const double left = (a(u) - c(u)) * (b(v) - c(v)), right = (a(v) - c(v)) * (b(u) - c(u));
  if (std::abs(left - right) > bound * (std::abs(left) + std::abs(right))) return sign(left - right);
  if (left == 0 && right == 0) return 0;
  const auto minus_c = [&](const Vec3& p, int i) {
    return static_cast<WideFloat>(p(i)) - static_cast<WideFloat>(c(i));
  };
  return sign(minus_c(a, u) * minus_c(b, v) - minus_c(a, v) * minus_c(b, u));
}

}  // namespace skinbem
