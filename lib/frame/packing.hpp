// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Rest positions and response matrix as the panels of a frame. Offline; internal to the floor.
#pragma once

#include <vector>

#include <skinbem/base/types.hpp>
#include <skinbem/frame/aligned_buffer.hpp>
#include <skinbem/frame/panel_product.hpp>

namespace skinbem::detail {

/// The memory of a PanelMatrix.
struct PackedPanels {
  AlignedVector<std::byte> data;
  std::vector<PanelPlace> places;
  std::size_t vertices = 0;
  bool quantised = false;
  /// max_i sum_k |E_ik|, E the error of R and |.| the Frobenius norm of a 3 by 3 block: times the distance that every
  /// landmark stays within, it bounds the error of any vertex's displacement. 0 in single precision.
  double error_factor = 0;

  PanelMatrix matrix() const { return {data.data(), places.data(), vertices, quantised}; }
};

/// `rest`: #V by 3. `response`: 3 #V by #columns.
PackedPanels pack_float32(const Points& rest, const Eigen::MatrixXd& response);

/// As int16 with a scale for every column of every panel, the largest magnitude in it being 32767. A panel whose error
/// factor is above `error_factor` gets remainders, themselves int16, of the columns that matter most until it is not.
/// Three adjacent columns belong to a landmark.
PackedPanels pack_int16(const Points& rest, const Eigen::MatrixXd& response, double error_factor);

}  // namespace skinbem::detail
