// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Which rows of a panel a triangle is near to.
#pragma once

#include <algorithm>
#include <type_traits>

#include <skinbem/kernels/panel_reach.hpp>
#include <skinbem/operator/element_integral.hpp>
#include <skinbem/operator/row_panel.hpp>

namespace skinbem::detail {

/// Which points of a panel are near a triangle, and the Gauss rule that serves the others: one for each half where a
/// vector holds half a panel.
struct NearFarSplit {
  struct Far {
    PanelMask mask;
    const TriangleRule* rule;
  };
  PanelMask near;
  Far far[2];
};

/// Real is what the batches compute in.
template <class Real>
NearFarSplit near_far_split(const RowPanel& panel, const SourceTriangle& triangle, const RuleLadder& ladder) {
  constexpr PanelMask first_half = (1u << kPanel / 2) - 1u;
  const PanelReach found = panel_reach(panel.points, triangle.centroid, ladder.near_ratio2() * triangle.radius2);
  const PanelMask far = ~found.near & panel.mask();
  const auto rule = [&](double closest2) {  // rounding must not bring it below the last rung
    return ladder.rule(std::max(closest2 / triangle.radius2, ladder.near_ratio2()));
  };
  const auto [first, second] = found.closest2;
  NearFarSplit split{found.near & panel.mask(), {{far, rule(std::min(first, second))}, {0, nullptr}}};
  if constexpr (std::is_same_v<Real, double>) {
    const TriangleRule *of_first = rule(first), *of_second = rule(second);
    if (of_first != of_second) {
      split.far[0] = {far & first_half, of_first};
      split.far[1] = {far & ~first_half, of_second};
    }
  }
  return split;
}

}  // namespace skinbem::detail
