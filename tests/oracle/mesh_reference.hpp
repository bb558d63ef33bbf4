// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Assembled matrices and response matrices of two small meshes, in quadruple precision.
#pragma once

#include <filesystem>
#include <skinbem/mesh/triangle_mesh.hpp>
#include <vector>

#include "element_oracle.hpp"

namespace skinbem::oracle {

using Matrix = Eigen::Matrix<Real, Eigen::Dynamic, Eigen::Dynamic>;

/// 3N x 3N, node-major x, y, z. Off its diagonal blocks H is the double layer against the hat functions; the diagonal
/// blocks follow from rigid translation, H 1 = 0. G is the single layer.
struct Assembled {
  Matrix H, G;
};
Assembled assemble(const TriangleMesh& mesh, const Kelvin<Real>& kernel);

/// R, 3N x 3Nk: u = R u_K from [H_U, -G_K] [u_U; t_K] = -H_K u_K.
Matrix response(const Assembled& a, const std::vector<int>& landmarks);

/// Writes the meshes, their landmarks, H, G and R at nu = 0.3 and 0.45; the files are described in
/// tests/reference/README.md.
void write_mesh_references(const std::filesystem::path& folder);

/// Assembles PREFIX.obj again and prints the largest differences from PREFIX_H_nu030.npy, PREFIX_G_nu030.npy and those
/// of nu045, relative to the largest entry.
void compare_mesh(const std::filesystem::path& prefix);

}  // namespace skinbem::oracle
