// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A response matrix of many landmarks, compressed patch by patch. Offline; internal to the floor.
#pragma once

#include <vector>

#include <skinbem/frame/packing.hpp>

namespace skinbem::detail {

/// R of a patch of neighbouring vertices as U Z: U has orthonormal columns, as many as the patch needs, and Z = U^T R.
/// Where they would be so many that nothing is gained the patch keeps its R. A frame is z = Z q for all patches at
/// once, then X + [U R] (z; q): two quantised panel products.
struct CompressedPanels {
  PackedPanels basis;        ///< [X U], the vertices by patches; entries name rows of Z; its error_factor is R's
  PackedPanels coordinates;  ///< Z without rest positions: row j is component j mod 3 of "vertex" j / 3
  std::vector<std::uint32_t> order;  ///< the vertex that each position of `basis` belongs to
  double largest_row = 0;            ///< largest sum of magnitudes in a row of Z

  std::size_t bytes() const { return basis.data.size() + coordinates.data.size(); }
};

/// `rest`: #V by 3. `response`: 3 #V by #columns. The ranks, and where remainders are needed, follow from
/// `error_factor`, which the whole keeps: see PackedPanels.
CompressedPanels compress(const Points& rest, const Eigen::MatrixXd& response, double error_factor);

}  // namespace skinbem::detail
