// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Duffy's transform: a triangle rule for integrands that are singular at one corner.
#pragma once

#include <Eigen/Core>
#include <skinbem/quadrature/gauss_legendre.hpp>

namespace skinbem {

/// Visits the points of Duffy's rule with `f(barycentric, weight)`: `const Eigen::Vector3d&`, double; the weights are
/// positive and sum to 1 (multiply by the area). `corner` (0, 1, 2) is the singular one; `radial` points lie on each of
/// `angular` rays from it.
///
/// With (u, v) in the unit square, y = (1-u) corner + u (1-v) next + u v last, dA = 2 A u du dv: the factor u cancels a
/// singularity 1/r at the corner, since r = u R(v). An integrand r^-1 times a polynomial of degree p in r leaves a
/// polynomial of degree p in u, so (p+2)/2 radial points are exact; the angular variable has the complex poles of R(v)
/// and converges geometrically, slowly for flat corners (near_singular.hpp places the rays better).
/// Source: M. G. Duffy, SIAM J. Numer. Anal. 19 (1982) 1260-1262.
template <class Visitor>
void for_each_duffy_point(int corner, int radial, int angular, Visitor&& f) {
  const GaussView u = gauss_legendre(radial);
  const GaussView v = gauss_legendre(angular);
  const int next = (corner + 1) % 3, last = (corner + 2) % 3;
  for (int j = 0; j < angular; ++j) {
    for (int i = 0; i < radial; ++i) {
      Eigen::Vector3d barycentric;
      barycentric[corner] = u.nodes[radial - 1 - i];  // 1 - u, by the rule's symmetry without rounding
      barycentric[next] = u.nodes[i] * v.nodes[angular - 1 - j];
      barycentric[last] = u.nodes[i] * v.nodes[j];
      f(barycentric, 2.0 * u.nodes[i] * u.weights[i] * v.weights[j]);
    }
  }
}

}  // namespace skinbem
