// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Which quadrature rule at which distance.
#pragma once

#include <array>
#include <span>
#include <vector>

#include <skinbem/quadrature/triangle_rules.hpp>

namespace skinbem {

/// Tolerances are accepted from here on.
inline constexpr double smallest_tolerance = 1e-13;

/// How accurately the operator integrates.
struct QuadratureOptions {
  /// Error of a block of H relative to its largest entry, smallest_tolerance to 1e-1. The integrals over single
  /// triangles are asked for half of it: a block is the sum of some six, whose values may cancel (docs/quadrature.md:
  /// without the half the worst block of a mesh errs by 1.7 times as much as its integrals may).
  double tolerance = 1e-8;

  /// Throws Error(usage) when a value is out of its range.
  void validate() const;
};

/// A Gauss rule and the measured model of its error: integrating a kernel of singularity r^-p against a hat function, a
/// rule of degree m errs by at most
///
///   c_m(p) (ratio - shift)^-m,   ratio = |x - centroid| / radius >= 1.6,
///
/// relative to the largest entry of the block; radius is the largest distance from the centroid to a vertex. The order
/// m (not m + 1) is the hat function's doing; the shift stands for the higher terms, which count near the triangle. The
/// constants were measured over triangles of all shapes to 1:100, positions and nu in extended precision; the model is
/// above what was measured by less than a factor of 2 or so at every distance (docs/quadrature.md has the plot; a test
/// repeats the measurement).
struct MeasuredRule {
  static constexpr double shift = 0.3;
  TriangleRule rule;
  std::array<double, 2> constant;  ///< c_m for kernels of singularity 1 and 2

  double error(double ratio, int singularity) const;  ///< by the model
  double ratio(double error, int singularity) const;  ///< from which on the error is no more
};

/// The rules that ladders are made of, cheapest first.
const std::vector<MeasuredRule>& measured_rules();

/// A Gauss rule and the distance from which it meets the tolerance.
struct Rung {
  const TriangleRule* rule;
  double min_ratio2;  ///< smallest (|x - centroid| / radius)^2, radius = largest distance from the centroid to a vertex
};

/// The Gauss rules worth using for a tolerance, cheapest first; nearer than the last one the closed form is used.
class RuleLadder {
 public:
  /// `singularity` is the kernel's order p, 1 or 2.
  RuleLadder(double tolerance, int singularity);

  std::span<const Rung> rungs() const { return rungs_; }
  /// Below this squared ratio no rule of the ladder is accurate enough.
  double near_ratio2() const { return rungs_.back().min_ratio2; }
  /// The cheapest rule at this squared ratio; nullptr below near_ratio2().
  const TriangleRule* rule(double ratio2) const {
    for (const Rung& rung : rungs_) {
      if (ratio2 >= rung.min_ratio2) return rung.rule;
    }
    return nullptr;
  }

 private:
  std::vector<Rung> rungs_;
};

}  // namespace skinbem
