// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Many field points at once: the layout that the operator hands to a kernel, and the scalar way to integrate it.
/// A kernel with a SIMD version overloads these two functions (kelvin_batch.hpp).
#pragma once

#include <array>
#include <bit>
#include <cstddef>

#include <Eigen/Core>

namespace skinbem {

/// Field points are handled in panels of this many: a multiple of every vector length.
inline constexpr std::size_t kPanel = 16;

/// Which points of a panel are meant: bit p is point p.
using PanelMask = unsigned;

/// Coordinates of a panel of field points, structure of arrays. Unused places repeat a used point.
struct PointPanel {
  alignas(64) double x[kPanel];
  alignas(64) double y[kPanel];
  alignas(64) double z[kPanel];

  Eigen::Vector3d point(std::size_t p) const { return {x[p], y[p], z[p]}; }
};

/// Gauss points of one flat triangle; #count each.
struct SourcePoints {
  std::size_t count;
  const double* x;
  const double* y;
  const double* z;
  const double* weights[3];  ///< weight x area x hat function of each vertex
};

/// Point sources of the double layer: places and unit normals; #count each.
struct Dipoles {
  std::size_t count;
  const double* x;
  const double* y;
  const double* z;
  const double* normal[3];
};

/// Components of the field at single points: rows of a matrix of dipoles. #count, a multiple of kPanel, each array
/// aligned to 64 bytes.
template <class Real>
struct FieldRows {
  std::size_t count;
  const Real* x;
  const Real* y;
  const Real* z;
  const Real* component;  ///< i of T_ij: 0, 1 or 2
};

/// Components of dipoles: columns of a matrix. Dipoles of which the same components are there stand together.
template <class Real>
struct DipoleColumns {
  std::array<std::size_t, 8> with;  ///< number of dipoles by set of components (bit j for T_ij), in this order
  const Real* x;
  const Real* y;
  const Real* z;
  const Real* normal[3];
};

/// The matrix T_ij(x_r; y_q, n_q), column by column to out[k rows.count + r], aligned to 64 bytes; columns k in the
/// order of the dipoles, those of one dipole by rising j. No point may be a dipole's place.
template <class Kernel, class Real>
void dipole_matrix(const Kernel& kernel, const FieldRows<Real>& rows, const DipoleColumns<Real>& dipoles, Real* out) {
  std::size_t q = 0;
  for (unsigned set = 0; set < dipoles.with.size(); ++set) {
    for (const std::size_t end = q + dipoles.with[set]; q < end; ++q) {
      const Eigen::Vector3d n(dipoles.normal[0][q], dipoles.normal[1][q], dipoles.normal[2][q]);
      for (unsigned j = 0; j < Kernel::components; ++j) {
        if (!(set >> j & 1)) continue;
        for (std::size_t r = 0; r < rows.count; ++r) {
          const Eigen::Vector3d to(dipoles.x[q] - rows.x[r], dipoles.y[q] - rows.y[r], dipoles.z[q] - rows.z[r]);
          *out++ = static_cast<Real>(kernel.double_layer(to, n)(Eigen::Index(rows.component[r]), j));
        }
      }
    }
  }
}

/// The double layer's values T_ij(x_p; y_q, n_q) of every dipole q at every point p of a panel, to
/// out[(q components^2 + components i + j) kPanel + p], aligned to 64 bytes. No point may be a dipole's place.
template <class Kernel>
void double_layer_of_dipoles(const Kernel& kernel, const PointPanel& panel, const Dipoles& dipoles, double* out) {
  constexpr int entries = Kernel::components * Kernel::components;
  for (std::size_t q = 0; q < dipoles.count; ++q) {
    const Eigen::Vector3d y(dipoles.x[q], dipoles.y[q], dipoles.z[q]);
    const Eigen::Vector3d n(dipoles.normal[0][q], dipoles.normal[1][q], dipoles.normal[2][q]);
    for (std::size_t p = 0; p < kPanel; ++p) {
      const typename Kernel::Block value = kernel.double_layer(y - panel.point(p), n);
      for (int e = 0; e < entries; ++e) {
        out[(q * entries + e) * kPanel + p] = value(e / Kernel::components, e % Kernel::components);
      }
    }
  }
}

/// Adds int N_v T_ij dS at the points of `mask` to out[v][(components i + j) kPanel + p], v = 0, 1, 2; n is the
/// triangle's unit normal. Each out[v] is aligned to 64 bytes. Real is double, or float where errors of some 1e-6 of
/// the largest entry are small enough; this version sums in it, others compute in it.
template <class Kernel, class Real>
void add_double_layer(const Kernel& kernel, const PointPanel& panel, PanelMask mask, const SourcePoints& source,
                      const Eigen::Vector3d& n, Real* const out[3]) {
  for (; mask != 0; mask &= mask - 1) {
    const std::size_t p = static_cast<std::size_t>(std::countr_zero(mask));
    for (std::size_t q = 0; q < source.count; ++q) {
      const Eigen::Vector3d r = Eigen::Vector3d(source.x[q], source.y[q], source.z[q]) - panel.point(p);
      const typename Kernel::Block value = kernel.double_layer(r, n);
      for (int e = 0; e < Kernel::components * Kernel::components; ++e) {
        const double entry = value(e / Kernel::components, e % Kernel::components);
        for (int v = 0; v < 3; ++v) out[v][e * kPanel + p] += static_cast<Real>(source.weights[v][q] * entry);
      }
    }
  }
}

/// Adds int (sum_v N_v) U_ij dS, the weights of the three hat functions summed, to out[(components i + j) kPanel + p].
template <class Kernel>
void add_single_layer(const Kernel& kernel, const PointPanel& panel, PanelMask mask, const SourcePoints& source,
                      double* out) {
  for (; mask != 0; mask &= mask - 1) {
    const std::size_t p = static_cast<std::size_t>(std::countr_zero(mask));
    for (std::size_t q = 0; q < source.count; ++q) {
      const Eigen::Vector3d r = Eigen::Vector3d(source.x[q], source.y[q], source.z[q]) - panel.point(p);
      const double weight = source.weights[0][q] + source.weights[1][q] + source.weights[2][q];
      const typename Kernel::Block value = kernel.single_layer(r) * weight;
      for (int e = 0; e < Kernel::components * Kernel::components; ++e) {
        out[e * kPanel + p] += value(e / Kernel::components, e % Kernel::components);
      }
    }
  }
}

}  // namespace skinbem
