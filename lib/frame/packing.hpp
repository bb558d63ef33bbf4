// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Rest positions and response matrix as the panels of a frame. Offline; internal to the floor.
#pragma once

#include <array>
#include <vector>

#include <skinbem/base/aligned_buffer.hpp>
#include <skinbem/base/types.hpp>
#include <skinbem/frame/panel_product.hpp>

namespace skinbem::detail {

/// The memory of a PanelMatrix.
struct PackedPanels {
  AlignedVector<std::byte> data;
  std::vector<PanelPlace> places;
  std::size_t vertices = 0;
  bool quantised = false;
  bool in_turns = false;
  /// max_i sum_k |E_ik|, E the error of R and |.| the Frobenius norm of a 3 by 3 block: times the distance that every
  /// landmark stays within, it bounds the error of any vertex's displacement. 0 in single precision.
  double error_factor = 0;

  PanelMatrix matrix() const { return {data.data(), places.data(), vertices, quantised, in_turns}; }
};

/// Part of a column of a panel in int16.
struct QuantisedEntry {
  std::uint32_t column = 0;
  float scale = 0;
  std::array<std::int16_t, kColumnNumbers> numbers = {};
};

/// The best entry for `remainder`, 96 numbers of a panel's column, which become what is left.
QuantisedEntry quantise(std::uint32_t column, Eigen::Ref<Eigen::VectorXd> remainder);

/// Rows of `matrix` (node-major, any number of columns) for the vertices of panel p: 96 by #columns, components apart,
/// padded by zeros.
Eigen::MatrixXd panel_of(const Eigen::MatrixXd& matrix, std::size_t p);

/// max_i sum_k |E_ik| over the 32 vertices of a panel whose error is `error`, 96 by #columns.
double error_factor_of(const Eigen::MatrixXd& error);

/// Entries of a panel (96 by #columns, the first of which is number `first_column`) within `error_factor`, as of
/// pack_int16; `panel` becomes the error, `achieved` at least its factor.
std::vector<QuantisedEntry> quantise_panel(Eigen::MatrixXd& panel, std::size_t first_column, double error_factor,
                                           double& achieved);

/// Appends panel p of a quantised matrix.
void append_panel(const Points& rest, std::size_t p, const std::vector<QuantisedEntry>& entries, PackedPanels& packed);

/// `rest`: #V by 3. `response`: 3 #V by #columns.
PackedPanels pack_float32(const Points& rest, const Eigen::MatrixXd& response);

/// As int16 with a scale for every column of every panel, the largest magnitude in it being 32767. A panel whose error
/// factor is above `error_factor` gets remainders, themselves int16, of the columns that matter most until it is not.
/// Three adjacent columns belong to a landmark. `error`: where it is not null, what is lost, in the shape of
/// `response`.
PackedPanels pack_int16(const Points& rest, const Eigen::MatrixXd& response, double error_factor,
                        Eigen::MatrixXd* error = nullptr);

}  // namespace skinbem::detail
