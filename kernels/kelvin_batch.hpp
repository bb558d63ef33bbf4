// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Kelvin's kernels for a panel of field points in SIMD (Highway, instruction set chosen at run time). The scalar
/// versions in panel.hpp are the reference; the tests compare them. Squared distances must lie in the range of float.
#pragma once

#include <skinbem/kernels/kelvin.hpp>
#include <skinbem/kernels/panel.hpp>

namespace skinbem {

/// As the template in panel.hpp.
void add_double_layer(const Kelvin<double>& kernel, const PointPanel& panel, PanelMask mask, const SourcePoints& source,
                      const Eigen::Vector3d& n, double* const out[3]);
void add_double_layer(const Kelvin<double>& kernel, const PointPanel& panel, PanelMask mask, const SourcePoints& source,
                      const Eigen::Vector3d& n, float* const out[3]);

/// As the template in panel.hpp.
void add_single_layer(const Kelvin<double>& kernel, const PointPanel& panel, PanelMask mask, const SourcePoints& source,
                      double* out);

/// As the template in panel.hpp.
void double_layer_of_dipoles(const Kelvin<double>& kernel, const PointPanel& panel, const Dipoles& dipoles,
                             double* out);

/// As the template in panel.hpp.
void dipole_matrix(const Kelvin<double>& kernel, const FieldRows<float>& rows, const DipoleColumns<float>& dipoles,
                   float* out);
void dipole_matrix(const Kelvin<double>& kernel, const FieldRows<double>& rows, const DipoleColumns<double>& dipoles,
                   double* out);

/// Name of the instruction set in use, such as "AVX3".
const char* instruction_set();

}  // namespace skinbem
