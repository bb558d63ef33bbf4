// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The integral of a kernel over one flat triangle against its three hat functions, for one field point anywhere.
#pragma once

#include <algorithm>
#include <array>

#include <skinbem/operator/rule_ladder.hpp>
#include <skinbem/quadrature/closed_form.hpp>

namespace skinbem {

/// One triangle as the operator sees it.
struct SourceTriangle {
  TriangleGeometry<double> geometry;
  Eigen::Vector3d centroid;
  double radius2;  ///< squared largest distance from the centroid to a vertex
  int longest;     ///< the longest edge, opposite to this vertex

  SourceTriangle(const Eigen::Vector3d& v0, const Eigen::Vector3d& v1, const Eigen::Vector3d& v2)
      : geometry(v0, v1, v2), centroid((v0 + v1 + v2) / 3) {
    radius2 = std::max({(v0 - centroid).squaredNorm(), (v1 - centroid).squaredNorm(), (v2 - centroid).squaredNorm()});
    const auto& l = geometry.edge_lengths;
    longest = l[0] > l[1] ? (l[0] > l[2] ? 0 : 2) : (l[1] > l[2] ? 1 : 2);
  }

  double length() const { return geometry.edge_lengths[longest]; }
  /// Smallest height: over the longest edge.
  double height() const { return geometry.twice_area / length(); }
  /// Squared distance from x to the longest edge: to the triangle, up to its height.
  double distance2(const Eigen::Vector3d& x) const {
    const Eigen::Vector3d from = x - geometry.vertices[(longest + 1) % 3];
    const Eigen::Vector3d& along = geometry.tangents[longest];
    return (from - along * std::clamp(from.dot(along), 0.0, length())).squaredNorm();
  }
};

/// Integrates by the cheapest way that meets the tolerance: a Gauss rule where x is far, the closed form where it is
/// near, and where neither is accurate (a needle, x near compared with its length and far compared with its height) the
/// triangle is halved across its longest edge until one is. The closed form's rounding, measured: c ((distance /
/// height)^2 + length / height) with c = 1e-14 for the single layer, 5e-16 for the double layer; twice that is allowed
/// for.
template <class Kernel>
class ElementIntegral {
 public:
  using Block = typename Kernel::Block;
  using Blocks = std::array<Block, 3>;  ///< one per vertex of the triangle

  ElementIntegral(const Kernel& kernel, double tolerance)
      : kernel_(kernel),
        single_(tolerance, Kernel::single_layer_singularity),
        double_(tolerance, Kernel::double_layer_singularity),
        single_slenderness_(tolerance / 2e-14),
        double_slenderness_(tolerance / 1e-15) {}

  /// int N_v U dS.
  Blocks single_layer(const SourceTriangle& t, const Eigen::Vector3d& x) const {
    return integrate(
        t, x, single_, single_slenderness_, 0,
        [&](const SourceTriangle& s) {
          const auto m = single_layer_moments(s.geometry, x);
          return Blocks{kernel_.single_layer_integral(m[0]), kernel_.single_layer_integral(m[1]),
                        kernel_.single_layer_integral(m[2])};
        },
        [&](const Eigen::Vector3d& r) { return kernel_.single_layer(r); });
  }

  /// int N_v T dS. For x at a vertex of the triangle the block of that vertex does not exist and is not to be used.
  Blocks double_layer(const SourceTriangle& t, const Eigen::Vector3d& x) const {
    const Eigen::Vector3d& n = t.geometry.normal;
    return integrate(
        t, x, double_, double_slenderness_, 0,
        [&](const SourceTriangle& s) {
          const auto m = double_layer_moments(s.geometry, x);
          return Blocks{kernel_.double_layer_integral(m[0], n), kernel_.double_layer_integral(m[1], n),
                        kernel_.double_layer_integral(m[2], n)};
        },
        [&](const Eigen::Vector3d& r) { return kernel_.double_layer(r, n); });
  }

  const RuleLadder& double_layer_rules() const { return double_; }
  const RuleLadder& single_layer_rules() const { return single_; }
  const Kernel& kernel() const { return kernel_; }

 private:
  template <class Exact, class Value>
  Blocks integrate(const SourceTriangle& t, const Eigen::Vector3d& x, const RuleLadder& ladder, double slenderness,
                   int depth, const Exact& exact, const Value& value) const {
    if (const TriangleRule* rule = ladder.rule((x - t.centroid).squaredNorm() / t.radius2))
      return gauss(t, x, *rule, value);
    constexpr int deepest = 24;
    const double height = t.height();
    const bool fat = t.length() <= 4 * height;  // halving would not help
    if (fat || depth == deepest || t.distance2(x) + t.length() * height <= slenderness * height * height)
      return exact(t);
    return halves(t, x, ladder, slenderness, depth, exact, value);
  }

  template <class Value>
  Blocks gauss(const SourceTriangle& t, const Eigen::Vector3d& x, const TriangleRule& rule, const Value& value) const {
    const auto& v = t.geometry.vertices;
    Blocks sum = {Block::Zero(), Block::Zero(), Block::Zero()};
    for (int q = 0; q < rule.size(); ++q) {
      const Eigen::Vector3d b = rule.barycentric.col(q);
      const Eigen::Vector3d y = b[0] * v[0] + b[1] * v[1] + b[2] * v[2];
      const Block weighted = value(y - x) * (rule.weights[q] * t.geometry.twice_area / 2);
      for (int a = 0; a < 3; ++a) sum[a] += b[a] * weighted;
    }
    return sum;
  }

  /// With m the middle of the longest edge ij, opposite to k: on either half the hat functions of the whole are
  /// combinations of those of the half, N_i = N'_i + N'_m / 2 and so on.
  template <class Exact, class Value>
  Blocks halves(const SourceTriangle& t, const Eigen::Vector3d& x, const RuleLadder& ladder, double slenderness,
                int depth, const Exact& exact, const Value& value) const {
    const int k = t.longest;
    const int i = (k + 1) % 3, j = (k + 2) % 3;
    const auto& v = t.geometry.vertices;
    const Eigen::Vector3d m = (v[i] + v[j]) / 2;
    const Blocks first = integrate(SourceTriangle(v[k], v[i], m), x, ladder, slenderness, depth + 1, exact, value);
    const Blocks second = integrate(SourceTriangle(v[k], m, v[j]), x, ladder, slenderness, depth + 1, exact, value);
    Blocks sum;
    sum[k] = first[0] + second[0];
    sum[i] = first[1] + (first[2] + second[1]) / 2;
    sum[j] = second[2] + (first[2] + second[1]) / 2;
    return sum;
  }

  Kernel kernel_;
  RuleLadder single_;
  RuleLadder double_;
  double single_slenderness_;  ///< bound of (distance / height)^2 + length / height for the closed form
  double double_slenderness_;
};

}  // namespace skinbem
