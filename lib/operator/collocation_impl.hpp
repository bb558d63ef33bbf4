// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The bodies of Collocation's members. Include it in one source file to use Collocation with a kernel of your own;
/// those of the library are compiled in collocation.cpp.
#pragma once

#include <omp.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <exception>
#include <numeric>
#include <string>

#include <skinbem/operator/collocation.hpp>
#include <skinbem/operator/column_block.hpp>
#include <skinbem/operator/far_patch.hpp>
#include <skinbem/operator/gauss_points.hpp>
#include <skinbem/operator/morton_order.hpp>
#include <skinbem/operator/panel_integral.hpp>
#include <skinbem/operator/row_panel.hpp>

namespace skinbem {
template <class Kernel>
Index Collocation<Kernel>::panel_count() const {
  return (node_count() + Index(kPanel) - 1) / Index(kPanel);
}

template <class Kernel>
template <class Real, class Body>
void Collocation<Kernel>::for_each_panel(const Progress& progress, std::string_view stage, const Body& body) const {
  std::exception_ptr failure;
  std::atomic<bool> failed = false;
  std::atomic<Index> done = 0;
  const Index panels = panel_count();
#pragma omp parallel
  {
    ColumnBlock<Real> block;
#pragma omp for schedule(dynamic, 1)
    for (Index k = 0; k < panels; ++k) {
      if (failed) continue;
      try {
        const Index first = k * Index(kPanel);
        const Index count = std::min(Index(kPanel), node_count() - first);
        body(k, Panel(vertices_, std::span(order_).subspan(first, count)), block);
        const Index finished = ++done;
        if (omp_get_thread_num() == 0) report(progress, stage, double(finished) / double(panels));
      } catch (...) {
#pragma omp critical(skinbem_collocation_failure)
        if (!failed.exchange(true)) failure = std::current_exception();
      }
    }
  }
  if (failure) std::rethrow_exception(failure);
}

template <class Kernel>
Collocation<Kernel>::Collocation(const TriangleMesh& mesh, const Kernel& kernel, const QuadratureOptions& options)
    : triangles_of_vertex_(triangles_around_vertices(mesh)),
      scale_(unit_scale(mesh)),
      tolerance_(options.tolerance),
      integral_(kernel, element_tolerance(tolerance_)) {
  vertices_.resize(mesh.vertex_count());
  for (Index v = 0; v < mesh.vertex_count(); ++v) vertices_[v] = mesh.vertices.row(v).transpose() * scale_;
  triangles_.resize(mesh.triangle_count());
  sources_.reserve(mesh.triangle_count());
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    if (!(area_vector(mesh, t).norm() > 0)) {
      throw Error(ErrorCode::bad_input,
                  "triangle " + std::to_string(t) + " has no area; remove it and its vertices' duplicates");
    }
    for (int c = 0; c < 3; ++c) triangles_[t][c] = mesh.triangles(t, c);
    const auto& v = triangles_[t];
    sources_.emplace_back(vertices_[v[0]], vertices_[v[1]], vertices_[v[2]]);
  }
  order_ = detail::morton_order(vertices_);
}

template <class Kernel>
Collocation<Kernel> Collocation<Kernel>::with_tolerance(double tolerance) const {
  Collocation other = *this;
  other.tolerance_ = tolerance;
  other.integral_ = ElementIntegral<Kernel>(kernel(), element_tolerance(tolerance));
  return other;
}

/// Each with the first of its vertices that is asked for. `slot_of` is by vertex, -1 for those that are not.
template <class Kernel>
std::vector<std::int32_t> Collocation<Kernel>::triangles_around(std::span<const std::int32_t> columns,
                                                                std::span<const std::int32_t> slot_of) const {
  std::vector<std::int32_t> found;
  for (const std::int32_t v : columns) {
    for (const std::int32_t t : triangles_of_vertex_[v]) {
      const auto& corners = triangles_[t];
      const auto sooner = [&](std::int32_t corner) { return slot_of[corner] >= 0 && slot_of[corner] < slot_of[v]; };
      if (std::none_of(corners.begin(), corners.end(), sooner)) found.push_back(t);
    }
  }
  return found;
}

template <class Kernel>
template <class Real>
unsigned Collocation<Kernel>::add_triangle(const Panel& panel, Index t, detail::GaussPoints& gauss,
                                           ColumnBlock<Real>& block) const {
  const auto& v = triangles_[t];
  Real* const out[3] = {block.slot_at(v[0]), block.slot_at(v[1]), block.slot_at(v[2])};
  return detail::add_double_layer_of(sources_[t], v, panel, integral_, gauss, out);
}

/// The rows of a panel, all columns, and their diagonal blocks by rigid translation. Some columns at a time, so that
/// what is read stays in the first-level cache and what is written fills whole cache lines.
template <class Kernel>
template <class Real>
void Collocation<Kernel>::store_rows(const Panel& panel, ColumnBlock<Real>& block, RowMajorMatrix& H) const {
  constexpr Index stretch = 8;
  const Index n = node_count();
  std::array<typename Kernel::Block, kPanel> sums;
  sums.fill(Kernel::Block::Zero());
  for (Index first = 0; first < n; first += stretch) {
    for (std::size_t p = 0; p < panel.count; ++p) {
      const Index row = components * Index(panel.vertex[p]);
      for (Index column = first; column < std::min(n, first + stretch); ++column) {
        const typename Kernel::Block entry = block.entry(column, p);
        H.template block<components, components>(row, components * column) = entry;
        sums[p] += entry;
      }
    }
  }
  for (std::size_t p = 0; p < panel.count; ++p) {
    const Index row = components * Index(panel.vertex[p]);
    H.template block<components, components>(row, row) = -sums[p];  // add_triangle left the block zero
  }
}

template <class Kernel>
template <class Real>
void Collocation<Kernel>::fill(RowMajorMatrix& H, const Progress& progress, std::span<AssemblyCounts> counts) const {
  std::vector<std::int32_t> slots(vertices_.size());
  std::iota(slots.begin(), slots.end(), 0);
  for_each_panel<Real>(progress, "assemble", [&](Index k, const Panel& panel, ColumnBlock<Real>& block) {
    block.prepare(slots, slots.size());
    detail::GaussPoints gauss;
    counts[k].pairs = panel.count * triangles_.size();
    for (Index t = 0; t < Index(triangles_.size()); ++t) counts[k].near += add_triangle(panel, t, gauss, block);
    store_rows(panel, block, H);
  });
}

template <class Kernel>
RowMajorMatrix Collocation<Kernel>::double_layer_matrix(const Progress& progress, AssemblyCounts* counts) const {
  RowMajorMatrix H(components * node_count(), components * node_count());
  std::vector<AssemblyCounts> counted(panel_count());
  in_single_precision() ? fill<float>(H, progress, counted) : fill<double>(H, progress, counted);
  if (counts) {
    for (const AssemblyCounts& c : counted) {
      counts->pairs += c.pairs;
      counts->near += c.near;
    }
  }
  return H;
}

/// Calls store(first, count, entries) for each panel of rows. Two are made at once: they share the triangles' Gauss
/// points, and their entries stay in the second-level cache.
template <class Kernel>
template <class Real, class Store>
void Collocation<Kernel>::make_panels(std::span<const std::int32_t> rows, std::span<const std::int32_t> columns,
                                      const Store& store) const {
  constexpr std::size_t together = 2;
  thread_local std::vector<std::int32_t> slots;
  thread_local ColumnBlock<Real> blocks[together];
  slots.resize(std::max(slots.size(), vertices_.size()), -1);
  for (std::size_t c = 0; c < columns.size(); ++c) slots[columns[c]] = static_cast<std::int32_t>(c);
  const std::vector<std::int32_t> triangles = triangles_around(columns, slots);

  detail::GaussPoints gauss;
  std::vector<Panel> panels;
  for (std::size_t first = 0; first < rows.size(); first += together * kPanel) {
    panels.clear();
    for (std::size_t row = first; row < std::min(rows.size(), first + together * kPanel); row += kPanel) {
      blocks[panels.size()].prepare(slots, columns.size());
      panels.emplace_back(vertices_, rows.subspan(row, std::min(kPanel, rows.size() - row)));
    }
    for (const std::int32_t t : triangles) {
      for (std::size_t k = 0; k < panels.size(); ++k) add_triangle(panels[k], t, gauss, blocks[k]);
    }
    for (std::size_t k = 0; k < panels.size(); ++k) store(first + k * kPanel, panels[k].count, blocks[k].slot(0));
  }
  for (const std::int32_t v : columns) slots[v] = -1;
}

template <class Kernel>
void Collocation<Kernel>::for_double_layer_panels(
    std::span<const std::int32_t> rows, std::span<const std::int32_t> columns,
    const std::function<void(std::size_t, std::size_t, const double*)>& store) const {
  if (!in_single_precision()) {
    make_panels<double>(rows, columns, store);
    return;
  }
  const std::size_t size = columns.size() * ColumnBlock<float>::entries * kPanel;
  thread_local detail::AlignedVector<double> wide;
  wide.resize(size);
  make_panels<float>(rows, columns, [&](std::size_t first, std::size_t count, const float* entries) {
    std::copy_n(entries, size, wide.data());
    store(first, count, wide.data());
  });
}

template <class Kernel>
void Collocation<Kernel>::for_double_layer_panels(
    std::span<const std::int32_t> rows, std::span<const std::int32_t> columns,
    const std::function<void(std::size_t, std::size_t, const float*)>& store) const {
  make_panels<float>(rows, columns, store);
}

template <class Kernel>
void Collocation<Kernel>::double_layer_block(std::span<const std::int32_t> rows, std::span<const std::int32_t> columns,
                                             Eigen::Ref<Eigen::MatrixXd> out) const {
  constexpr int entries = components * components;
  for_double_layer_panels(rows, columns, [&](std::size_t first, std::size_t count, const double* values) {
    for (std::size_t c = 0; c < columns.size(); ++c) {
      for (int e = 0; e < entries; ++e) {
        const double* from = values + (c * entries + e) * kPanel;
        for (std::size_t p = 0; p < count; ++p) {
          out(components * Index(first + p) + e / components, components * Index(c) + e % components) = from[p];
        }
      }
    }
  });
}

template <class Kernel>
Eigen::MatrixXd Collocation<Kernel>::single_layer_columns(std::span<const LoadedPiece> density) const {
  std::vector<SourceTriangle> sources;
  for (const LoadedPiece& piece : density) {
    const auto& v = triangles_[piece.triangle];
    const auto corner = [&](int k) -> Eigen::Vector3d {
      const auto b = piece.corners.col(k);
      return b[0] * vertices_[v[0]] + b[1] * vertices_[v[1]] + b[2] * vertices_[v[2]];
    };
    sources.emplace_back(corner(0), corner(1), corner(2));
  }
  const std::optional<detail::FarPatch> far = far_patch(sources, density);
  Eigen::MatrixXd G(components * node_count(), components);
  for_each_panel<double>({}, "", [&](Index, const Panel& panel, ColumnBlock<double>& block) {
    block.prepare({}, 0);
    if (far && far->serves(panel)) {
      add_single_layer(integral_.kernel(), panel.points, panel.mask(), far->points(), block.slot(0));
    } else {
      detail::GaussPoints gauss;
      for (std::size_t k = 0; k < sources.size(); ++k) {
        detail::add_single_layer_of(sources[k], density[k].density, panel, integral_, gauss, block.slot(0));
      }
    }
    for (std::size_t p = 0; p < panel.count; ++p) {
      G.template block<components, components>(components * Index(panel.vertex[p]), 0) = block.entry(0, p) / scale_;
    }
  });
  return G;
}

template <class Kernel>
Eigen::MatrixXd Collocation<Kernel>::single_layer_columns(std::span<const VertexWeight> density) const {
  std::vector<std::int32_t> support, slots(vertices_.size(), -1);
  std::vector<double> value(vertices_.size(), 0.0);
  for (const VertexWeight& d : density) {
    if (slots[d.vertex] < 0) {
      slots[d.vertex] = static_cast<std::int32_t>(support.size());
      support.push_back(d.vertex);
    }
    value[d.vertex] += d.value;
  }
  std::vector<LoadedPiece> triangles;
  for (const std::int32_t t : triangles_around(support, slots)) {
    const auto& v = triangles_[t];
    triangles.push_back({t, Mat3::Identity(), {value[v[0]], value[v[1]], value[v[2]]}});
  }
  return single_layer_columns(triangles);
}

/// Triangles with a density on each, from afar; nothing where they are too few for that to save time.
template <class Kernel>
std::optional<detail::FarPatch> Collocation<Kernel>::far_patch(std::span<const SourceTriangle> sources,
                                                               std::span<const LoadedPiece> density) const {
  if (sources.empty()) return {};
  Eigen::AlignedBox3d box;
  for (const SourceTriangle& source : sources) {
    for (const auto& corner : source.geometry.vertices) box.extend(corner);
  }
  detail::FarPatch far(box, integral_.tolerance());
  const double distance = (detail::FarPatch::separation - 1) * far.radius();
  std::vector<const TriangleRule*> rules;
  std::size_t points = 0;
  for (const SourceTriangle& source : sources) {
    rules.push_back(integral_.single_layer_rules().rule(distance * distance / source.radius2));
    if (!rules.back()) return {};
    points += std::size_t(rules.back()->size());
  }
  if (points < 2 * far.size()) return {};
  detail::GaussPoints gauss;
  for (std::size_t k = 0; k < sources.size(); ++k) {
    far.add(gauss.of(sources[k].geometry, *rules[k], density[k].density));
  }
  return far;
}

}  // namespace skinbem
