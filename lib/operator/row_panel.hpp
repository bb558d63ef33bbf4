// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The rows of a matrix that are made together.
#pragma once

#include <algorithm>
#include <cstdint>
#include <span>
#include <vector>

#include <skinbem/kernels/panel.hpp>

namespace skinbem::detail {

/// Up to kPanel vertices as field points. Unused places repeat the last one.
struct RowPanel {
  PointPanel points;
  std::int32_t vertex[kPanel];
  std::size_t count;

  RowPanel(const std::vector<Eigen::Vector3d>& vertices, std::span<const std::int32_t> rows) : count(rows.size()) {
    for (std::size_t p = 0; p < kPanel; ++p) {
      vertex[p] = rows[std::min(p, count - 1)];
      points.x[p] = vertices[vertex[p]][0];
      points.y[p] = vertices[vertex[p]][1];
      points.z[p] = vertices[vertex[p]][2];
    }
  }
  PanelMask mask() const { return (1u << count) - 1u; }
};

}  // namespace skinbem::detail
