// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Collocation of a kernel at the vertices of a mesh, with piecewise linear densities: the one place where matrix
/// entries are made. Everything above (dense matrix, compression, landmark columns) asks for blocks of it.
#pragma once

#include <functional>
#include <optional>
#include <span>
#include <vector>

#include <skinbem/base/progress.hpp>
#include <skinbem/kernels/kelvin.hpp>
#include <skinbem/kernels/laplace.hpp>
#include <skinbem/kernels/panel.hpp>
#include <skinbem/mesh/adjacency.hpp>
#include <skinbem/mesh/triangle_mesh.hpp>
#include <skinbem/operator/element_integral.hpp>
#include <skinbem/operator/loaded_piece.hpp>

namespace skinbem {
namespace detail {
struct RowPanel;
class FarPatch;
class GaussPoints;
template <class Kernel, class Real>
class ColumnBlock;
}  // namespace detail

/// Where the work went.
struct AssemblyCounts {
  std::uint64_t pairs = 0;  ///< vertex-triangle pairs
  std::uint64_t near = 0;   ///< of them, integrated in closed form (the singular ones too)
};

/// Matrices are node-major: row components k + i belongs to direction i at vertex k. Results do not depend on the
/// number of threads.
template <class Kernel>
class Collocation {
 public:
  static constexpr int components = Kernel::components;

  /// Keeps a copy of what it needs of the mesh. Throws Error(bad_input) naming the first triangle without area,
  /// Error(usage) for bad options.
  Collocation(const TriangleMesh& mesh, const Kernel& kernel, const QuadratureOptions& options = {});

  Index node_count() const { return static_cast<Index>(vertices_.size()); }
  const Kernel& kernel() const { return integral_.kernel(); }
  /// The same to another tolerance (QuadratureOptions::tolerance).
  Collocation with_tolerance(double tolerance) const;
  double tolerance() const { return tolerance_; }

  /// The double layer's matrix H of c u + int T u dS, dense, square: off the diagonal int N_l T(x_k, .) dS, diagonal
  /// blocks by rigid translation, so that H 1 = 0 (and free term and principal value never appear). For an exterior
  /// problem: I - H.
  RowMajorMatrix double_layer_matrix(const Progress& progress = {}, AssemblyCounts* counts = nullptr) const;

  /// The rows and columns of H that belong to these vertices, as they are made: kPanel rows at a time. Calls
  /// store(first, count, entries) for rows first to first + count - 1, with entry (i, j) of row first + p and column c
  /// in entries[(c components^2 + components i + j) kPanel + p], aligned to 64 bytes, zero for p >= count. Diagonal
  /// blocks (a vertex in both lists) are left zero. One thread; any number of calls at a time.
  void for_double_layer_panels(
      std::span<const std::int32_t> rows, std::span<const std::int32_t> columns,
      const std::function<void(std::size_t first, std::size_t count, const double* entries)>& store) const;
  /// The same in single precision whatever the tolerance: errors of some 1e-6 of the largest entry of a block.
  void for_double_layer_panels(
      std::span<const std::int32_t> rows, std::span<const std::int32_t> columns,
      const std::function<void(std::size_t first, std::size_t count, const float* entries)>& store) const;

  /// The same as a matrix, written to `out`: components #rows by components #columns.
  void double_layer_block(std::span<const std::int32_t> rows, std::span<const std::int32_t> columns,
                          Eigen::Ref<Eigen::MatrixXd> out) const;

  /// Columns of G for one density: components N by components, row block k is int U(x_k, .) density dS. Far from many
  /// triangles these are replaced by fewer sources, to the same tolerance.
  Eigen::MatrixXd single_layer_columns(std::span<const LoadedPiece> density) const;
  Eigen::MatrixXd single_layer_columns(std::span<const VertexWeight> density) const;

 private:
  using Panel = detail::RowPanel;
  template <class Real>
  using ColumnBlock = detail::ColumnBlock<Kernel, Real>;

  /// Of an integral over one triangle: an entry sums several.
  static double element_tolerance(double tolerance) { return std::max(smallest_tolerance, tolerance / 2); }
  /// Sums in float: where the tolerance is at least ten times their error.
  bool in_single_precision() const { return tolerance_ >= 1e-5; }
  Index panel_count() const;
  /// Calls body(k, panel, column block of the thread) for every panel of rows, on all threads.
  template <class Real, class Body>
  void for_each_panel(const Progress& progress, std::string_view stage, const Body& body) const;
  std::vector<std::int32_t> triangles_around(std::span<const std::int32_t> columns,
                                             std::span<const std::int32_t> slot_of) const;
  template <class Real>
  void fill(RowMajorMatrix& H, const Progress& progress, std::span<AssemblyCounts> counts) const;
  std::optional<detail::FarPatch> far_patch(std::span<const SourceTriangle> sources,
                                            std::span<const LoadedPiece> density) const;
  template <class Real, class Store>
  void make_panels(std::span<const std::int32_t> rows, std::span<const std::int32_t> columns, const Store& store) const;
  /// Returns how many points of the panel are near.
  template <class Real>
  unsigned add_triangle(const Panel& panel, Index t, detail::GaussPoints& gauss, ColumnBlock<Real>& block) const;
  template <class Real>
  void store_rows(const Panel& panel, ColumnBlock<Real>& block, RowMajorMatrix& H) const;

  std::vector<Eigen::Vector3d> vertices_;  ///< times scale_
  std::vector<std::array<std::int32_t, 3>> triangles_;
  std::vector<SourceTriangle> sources_;
  IndexLists triangles_of_vertex_;
  std::vector<std::int32_t> order_;  ///< vertices along a space-filling curve
  double scale_;  ///< a power of two, so that scaling is exact: the kernels' batches work near unit length
  double tolerance_;
  ElementIntegral<Kernel> integral_;
};

extern template class Collocation<Kelvin<double>>;
extern template class Collocation<Laplace<double>>;

}  // namespace skinbem
