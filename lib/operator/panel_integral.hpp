// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The integrals over one triangle for a panel of rows: by the kernel's batches where it is far, one by one where near.
#pragma once

#include <array>
#include <bit>

#include <skinbem/kernels/kelvin_batch.hpp>
#include <skinbem/operator/element_integral.hpp>
#include <skinbem/operator/gauss_points.hpp>
#include <skinbem/operator/near_far_split.hpp>

namespace skinbem::detail {

/// Calls body(p) for the points p of `mask`.
template <class Body>
void for_each_point(PanelMask mask, const Body& body) {
  for (; mask != 0; mask &= mask - 1) body(static_cast<std::size_t>(std::countr_zero(mask)));
}

template <class Block, class Real>
void add_block(const Block& block, Real* out) {
  for (Eigen::Index e = 0; e < Block::SizeAtCompileTime; ++e) {
    out[e * Eigen::Index(kPanel)] +=
        static_cast<Real>(block(e / Block::ColsAtCompileTime, e % Block::ColsAtCompileTime));
  }
}

/// Adds int N_c T dS to out[c][(components i + j) kPanel + p] for the triangle's three vertices `corners`, except where
/// row p is that vertex: those blocks come from rigid translation. Returns the number of near points.
template <class Kernel, class Real>
unsigned add_double_layer_of(const SourceTriangle& triangle, const std::array<std::int32_t, 3>& corners,
                             const RowPanel& panel, const ElementIntegral<Kernel>& integral, GaussPoints& gauss,
                             Real* const out[3]) {
  const NearFarSplit split = near_far_split<Real>(panel, triangle, integral.double_layer_rules());
  for (const auto& [mask, rule] : split.far) {
    if (mask == 0) continue;
    const SourcePoints points = gauss.of(triangle.geometry, *rule, {1, 1, 1});
    add_double_layer(integral.kernel(), panel.points, mask, points, triangle.geometry.normal, out);
  }
  for_each_point(split.near, [&](std::size_t p) {
    const auto blocks = integral.double_layer(triangle, panel.points.point(p));
    for (int c = 0; c < 3; ++c) {
      if (corners[c] != panel.vertex[p]) add_block(blocks[c], out[c] + p);
    }
  });
  return static_cast<unsigned>(std::popcount(split.near));
}

/// Adds int sum_c density_c N_c U dS to out[(components i + j) kPanel + p].
template <class Kernel>
void add_single_layer_of(const SourceTriangle& triangle, const Eigen::Vector3d& density, const RowPanel& panel,
                         const ElementIntegral<Kernel>& integral, GaussPoints& gauss, double* out) {
  const NearFarSplit split = near_far_split<double>(panel, triangle, integral.single_layer_rules());
  for (const auto& [mask, rule] : split.far) {
    if (mask == 0) continue;
    const SourcePoints points = gauss.of(triangle.geometry, *rule, density);
    add_single_layer(integral.kernel(), panel.points, mask, points, out);
  }
  for_each_point(split.near, [&](std::size_t p) {
    const auto blocks = integral.single_layer(triangle, panel.points.point(p));
    const typename Kernel::Block sum = blocks[0] * density[0] + blocks[1] * density[1] + blocks[2] * density[2];
    add_block(sum, out + p);
  });
}

}  // namespace skinbem::detail
