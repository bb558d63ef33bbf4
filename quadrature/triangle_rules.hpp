// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Rules for smooth integrands on a triangle.
#pragma once

#include <Eigen/Core>

namespace skinbem {

/// Points and weights on a triangle: the integral is area * sum_q weights[q] f(y_q), y_q = sum_a barycentric(a, q) v_a.
struct TriangleRule {
  int degree = 0;                ///< exact for polynomials of two variables up to this total degree
  Eigen::Matrix3Xd barycentric;  ///< 3 by #Q, every entry in (0, 1), columns sum to 1
  Eigen::VectorXd weights;       ///< #Q, positive, sum 1

  int size() const { return static_cast<int>(weights.size()); }
};

inline constexpr int max_symmetric_degree = 14;

/// The stored rule of fewest points that is exact to `degree` (1 to max_symmetric_degree). It has the full symmetry of
/// the triangle, all points inside and all weights positive. A degree between two stored ones gets the next.
/// The number of points is, degree: points, 1: 1, 2: 3, 4: 6, 5: 7, 6: 12, 7: 15, 8: 16, 9: 19, 10: 25, 11: 28, 12:
/// 33, 13: 37, 14: 42.
/// Built at its first use; any thread may ask; the reference stays valid and the rule never changes.
/// Throws std::invalid_argument for another degree.
///
/// Orbit structures after D. A. Dunavant, IJNME 21 (1985) 1129-1148; L. Zhang, T. Cui, H. Liu, J. Comput. Math. 27
/// (2009) 89-96; F. D. Witherden, P. E. Vincent, Comput. Math. Appl. 69 (2015) 1232-1241. The numbers were computed for
/// this library by tests/oracle/make_triangle_rules.cpp, which solves the moment equations in quadruple precision.
const TriangleRule& symmetric_triangle_rule(int degree);

/// n x n Gauss points collapsed onto corner 0, exact to degree 2n - 2; for orders beyond the symmetric rules.
TriangleRule collapsed_triangle_rule(int n);

}  // namespace skinbem
