// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Gauss-Legendre rules on [0, 1], computed for any order and any scalar.
#pragma once

#include <cmath>
#include <limits>
#include <numbers>
#include <span>
#include <stdexcept>
#include <type_traits>
#include <vector>

namespace skinbem {

/// n nodes in (0, 1), ascending and symmetric about 1/2, and n positive weights of sum 1.
template <class T>
struct GaussRule {
  std::vector<T> nodes;
  std::vector<T> weights;
};

namespace detail {

/// Legendre polynomial P_n and its derivative at z in (-1, 1), by the three-term recurrence.
template <class T>
struct LegendreValue {
  T p, dp;
};

template <class T>
LegendreValue<T> legendre(int n, T z) {
  T before = T(1), p = z;
  for (int k = 2; k <= n; ++k) {
    const T next = (T(2 * k - 1) * z * p - T(k - 1) * before) / T(k);
    before = p;
    p = next;
  }
  return {p, T(n) * (before - z * p) / ((T(1) - z) * (T(1) + z))};
}

}  // namespace detail

/// The n-point rule, exact for polynomials of degree 2n - 1. The roots of P_n come from Newton's method, started from
/// Tricomi's asymptotic formula (Abramowitz & Stegun 22.16.6); w = 1 / ((1 - z^2) P_n'(z)^2) on [0, 1]. In double the
/// work is done in long double, so that nodes and weights are right to about one unit in the last place.
/// Throws std::invalid_argument for n < 1.
template <class T>
GaussRule<T> make_gauss_legendre(int n) {
  if (n < 1) throw std::invalid_argument("Gauss-Legendre: the number of points must be at least 1");
  using Work = std::conditional_t<std::is_same_v<T, double> || std::is_same_v<T, float>, long double, T>;
  using std::abs;
  GaussRule<T> rule{std::vector<T>(n), std::vector<T>(n)};
  for (int i = 0; i < (n + 1) / 2; ++i) {
    Work z = Work((1.0 - (n - 1.0) / (8.0 * n * n * n)) * std::cos(std::numbers::pi * (4 * i + 3) / (4 * n + 2)));
    if (2 * i + 1 == n) z = Work(0);
    for (int step = 0; step < 20; ++step) {
      const auto value = detail::legendre(n, z);
      const Work change = value.p / value.dp;
      z -= change;
      if (abs(change) <= std::numeric_limits<Work>::epsilon()) break;
    }
    const Work dp = detail::legendre(n, z).dp;
    const Work weight = Work(1) / ((Work(1) - z) * (Work(1) + z) * dp * dp);
    rule.nodes[i] = static_cast<T>((Work(1) - z) / Work(2));
    rule.nodes[n - 1 - i] = static_cast<T>((Work(1) + z) / Work(2));
    rule.weights[i] = rule.weights[n - 1 - i] = static_cast<T>(weight);
  }
  return rule;
}

/// A rule that lives for the whole program.
struct GaussView {
  std::span<const double> nodes;
  std::span<const double> weights;
  int size() const { return static_cast<int>(nodes.size()); }
};

inline constexpr int max_cached_gauss_order = 200;

/// The n-point rule in double, 1 <= n <= max_cached_gauss_order, computed at its first use; any thread may ask at any
/// time, and what it gets never changes. Throws std::invalid_argument for another n.
GaussView gauss_legendre(int n);

}  // namespace skinbem
