// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The integral of a kernel over one flat triangle against its three hat functions, for one field point anywhere.
#pragma once

#include <algorithm>
#include <array>
#include <limits>

#include <skinbem/operator/rule_ladder.hpp>
#include <skinbem/quadrature/closed_form.hpp>
#include <skinbem/quadrature/near_singular.hpp>

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

/// What the closed form in double errs by at most, relative to the largest entry of a block, with d the distance of x,
/// l the longest edge and h the smallest height: measured over random triangles of aspect 1 to 1000 and positions
/// (docs/quadrature.md). In long double it is less by the ratio of the two epsilons.
inline double single_layer_rounding(const SourceTriangle& t, const Eigen::Vector3d& x) {
  const double l = t.length(), h = t.height();
  return (2e-15 * l * l + 2e-14 * t.distance2(x)) / (h * h);
}

/// The same for the double layer.
inline double double_layer_rounding(const SourceTriangle& t, const Eigen::Vector3d& x) {
  const double l = t.length(), h = t.height();
  return (6e-16 * l * l + 6e-15 * (l * h + t.distance2(x))) / (h * h);
}

/// Integrates by the cheapest way that meets the tolerance: a Gauss rule where x is far; where it is near the closed
/// form, in double or, where that rounds too much (needles), in long double, which takes five times as long; and where
/// even that is not enough the near-singular rule.
template <class Kernel>
class ElementIntegral {
 public:
  using Block = typename Kernel::Block;
  using Blocks = std::array<Block, 3>;  ///< one per vertex of the triangle

  ElementIntegral(const Kernel& kernel, double tolerance)
      : kernel_(kernel),
        tolerance_(tolerance),
        single_(tolerance, Kernel::single_layer_singularity),
        double_(tolerance, Kernel::double_layer_singularity) {}

  /// int N_v U dS.
  Blocks single_layer(const SourceTriangle& t, const Eigen::Vector3d& x) const {
    const auto value = [&](const Eigen::Vector3d& r) { return kernel_.single_layer(r); };
    if (const TriangleRule* rule = rule_at(t, x, single_)) return gauss(t, x, *rule, value);
    const double rounding = single_layer_rounding(t, x);
    if (rounding <= tolerance_) return closed_single_layer(t.geometry, x);
    if (long_double_serves(t, rounding)) return closed_single_layer(in_long_double(t), x);
    return near_singular(t, x, value);
  }

  /// int N_v T dS. For x at a vertex of the triangle the block of that vertex does not exist and is not to be used.
  Blocks double_layer(const SourceTriangle& t, const Eigen::Vector3d& x) const {
    const auto value = [&](const Eigen::Vector3d& r) { return kernel_.double_layer(r, t.geometry.normal); };
    if (const TriangleRule* rule = rule_at(t, x, double_)) return gauss(t, x, *rule, value);
    const double rounding = double_layer_rounding(t, x);
    if (rounding <= tolerance_) return closed_double_layer(t.geometry, x);
    if (long_double_serves(t, rounding)) return closed_double_layer(in_long_double(t), x);
    return near_singular(t, x, value);
  }

  const RuleLadder& double_layer_rules() const { return double_; }
  const RuleLadder& single_layer_rules() const { return single_; }
  const Kernel& kernel() const { return kernel_; }
  double tolerance() const { return tolerance_; }

 private:
  /// Whether the closed form in long double is to be used where it rounds by `rounding` in double: it is accurate
  /// enough, or the triangle is too thin for the near-singular rule, which refuses it.
  bool long_double_serves(const SourceTriangle& t, double rounding) const {
    constexpr double gain =
        double(std::numeric_limits<long double>::epsilon()) / std::numeric_limits<double>::epsilon();
    return rounding * gain <= tolerance_ || t.height() <= 1e-13 * t.length();
  }

  static TriangleGeometry<long double> in_long_double(const SourceTriangle& t) {
    const auto& v = t.geometry.vertices;
    return {v[0].cast<long double>(), v[1].cast<long double>(), v[2].cast<long double>()};
  }

  static const TriangleRule* rule_at(const SourceTriangle& t, const Eigen::Vector3d& x, const RuleLadder& ladder) {
    return ladder.rule((x - t.centroid).squaredNorm() / t.radius2);
  }

  template <class Real>
  Blocks closed_single_layer(const TriangleGeometry<Real>& g, const Eigen::Vector3d& x) const {
    const auto m = single_layer_moments<Real>(g, x.cast<Real>());
    Blocks blocks;
    for (int v = 0; v < 3; ++v) blocks[v] = kernel_.single_layer_integral(m[v].template cast<double>());
    return blocks;
  }

  template <class Real>
  Blocks closed_double_layer(const TriangleGeometry<Real>& g, const Eigen::Vector3d& x) const {
    const auto m = double_layer_moments<Real>(g, x.cast<Real>());
    const Eigen::Vector3d n = g.normal.template cast<double>();
    Blocks blocks;
    for (int v = 0; v < 3; ++v) blocks[v] = kernel_.double_layer_integral(m[v].template cast<double>(), n);
    return blocks;
  }

  template <class Value>
  Blocks near_singular(const SourceTriangle& t, const Eigen::Vector3d& x, const Value& value) const {
    const NearSingularRule rule(t.geometry, x, tolerance_ / 10);
    Blocks sum = {Block::Zero(), Block::Zero(), Block::Zero()};
    rule.for_each([&](const Eigen::Vector3d& r, const Eigen::Vector3d& hats, double weight) {
      const Block weighted = value(rule.frame().transpose() * r) * weight;
      for (int a = 0; a < 3; ++a) sum[a] += hats[a] * weighted;
    });
    return sum;
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

  Kernel kernel_;
  double tolerance_;
  RuleLadder single_;
  RuleLadder double_;
};

}  // namespace skinbem
