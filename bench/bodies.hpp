// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Bodies for the benchmarks.
#pragma once

#include <cmath>
#include <numbers>

#include <skinbem/mesh/triangle_mesh.hpp>

namespace skinbem::benchmarks {

/// An ellipsoid of a leg's size and slenderness (90 x 110 x 440 mm): `rings` rings of `around` vertices and two poles.
inline TriangleMesh leg_like(int rings, int around) {
  TriangleMesh mesh;
  mesh.vertices.resize(rings * around + 2, 3);
  mesh.triangles.resize(2 * rings * around, 3);
  const Vec3 axes(45, 55, 220);
  const auto node = [&](int i, int j) { return i * around + j % around; };
  const int south = rings * around, north = south + 1;
  Index t = 0;
  const auto triangle = [&](int a, int b, int c) { mesh.triangles.row(t++) << a, b, c; };
  for (int i = 0; i < rings; ++i) {
    const double z = -std::cos(std::numbers::pi * (i + 1) / (rings + 1));
    for (int j = 0; j < around; ++j) {
      const double angle = 2 * std::numbers::pi * (j + 0.5 * i) / around, rho = std::sqrt(1 - z * z);
      mesh.vertices.row(node(i, j)) = Vec3(rho * std::cos(angle), rho * std::sin(angle), z).cwiseProduct(axes);
      if (i == 0) {
        triangle(south, node(0, j + 1), node(0, j));
        continue;
      }
      triangle(node(i - 1, j), node(i - 1, j + 1), node(i, j));
      triangle(node(i - 1, j + 1), node(i, j + 1), node(i, j));
    }
  }
  for (int j = 0; j < around; ++j) triangle(north, node(rings - 1, j), node(rings - 1, j + 1));
  mesh.vertices.row(south) << 0, 0, -axes[2];
  mesh.vertices.row(north) << 0, 0, axes[2];
  return mesh;
}

/// About so many vertices; 602 for 600.
inline TriangleMesh leg_like_of(long vertices) {
  const int around = static_cast<int>(std::sqrt(static_cast<double>(vertices) / 1.5));
  return leg_like(static_cast<int>(vertices) / around, around);
}

}  // namespace skinbem::benchmarks
