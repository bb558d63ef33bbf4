// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Which quadrature rule at which distance.
#pragma once

#include <span>
#include <vector>

#include <skinbem/quadrature/triangle_rules.hpp>

namespace skinbem {

/// How accurately the operator integrates.
struct QuadratureOptions {
  /// Error of an element integral relative to the largest entry of its block; 1e-13 to 1e-1.
  double tolerance = 1e-8;

  /// Throws Error(usage) when a value is out of its range.
  void validate() const;
};

/// A Gauss rule and the distance from which it meets the tolerance.
struct Rung {
  const TriangleRule* rule;
  double min_ratio2;  ///< smallest (|x - centroid| / radius)^2, radius = largest distance from the centroid to a vertex
};

/// The Gauss rules worth using for a tolerance, cheapest first; nearer than the last one the closed form is used.
///
/// Error model: integrating a kernel of singularity r^-p against a hat function, a rule of degree m errs by at most
/// c_m(p) (radius / |x - centroid|)^m relative to the largest entry of the block, at |x - centroid| >= 1.6 radius. The
/// order m (not m + 1) is the hat function's doing. The constants were measured over triangles of all shapes, positions
/// and nu against the closed form in quadruple precision (docs/quadrature.md has the plot; a test repeats the
/// measurement in double).
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
