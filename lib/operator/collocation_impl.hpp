// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The bodies of Collocation's members. Include it in one source file to use Collocation with a kernel of your own;
/// those of the library are compiled in collocation.cpp.
#pragma once

#include <omp.h>

#include <algorithm>
#include <atomic>
#include <bit>
#include <cmath>
#include <exception>
#include <limits>
#include <numeric>

#include <skinbem/kernels/kelvin_batch.hpp>
#include <skinbem/kernels/panel_reach.hpp>
#include <skinbem/operator/collocation.hpp>

namespace skinbem {
namespace detail {

/// A panel's columns: for each vertex components^2 entries of kPanel points, aligned for the batches.
template <class Real>
struct AlignedBuffer {
  std::vector<Real> storage;
  Real* data = nullptr;

  void zero(std::size_t size) {
    storage.assign(size + 64 / sizeof(Real), Real(0));
    const auto address = reinterpret_cast<std::uintptr_t>(storage.data());
    data = storage.data() + (64 - address % 64) % 64 / sizeof(Real);
  }
};

/// Gauss points of one triangle for one rule, in the layout of the batches.
class GaussPoints {
 public:
  /// `density` scales the three hat functions. The points stay until the next call, and with the same triangle and rule
  /// beyond it: then the density must be the same, too.
  SourcePoints of(const TriangleGeometry<double>& g, const TriangleRule& rule, const Eigen::Vector3d& density) {
    if (triangle_ != &g || rule_ != &rule) make(g, rule, density);
    const std::size_t n = static_cast<std::size_t>(rule.size());
    const double* p = storage_.data();
    return {n, p, p + n, p + 2 * n, {p + 3 * n, p + 4 * n, p + 5 * n}};
  }

 private:
  void make(const TriangleGeometry<double>& g, const TriangleRule& rule, const Eigen::Vector3d& density) {
    const std::size_t n = static_cast<std::size_t>(rule.size());
    storage_.resize(6 * n);
    const double* b = rule.barycentric.data();
    const Eigen::Vector3d scale = density * (g.twice_area / 2);
    for (int k = 0; k < 3; ++k) {
      const double corner[3] = {g.vertices[0][k], g.vertices[1][k], g.vertices[2][k]};
      double* const place = storage_.data() + std::size_t(k) * n;
      double* const weight = place + 3 * n;
      for (std::size_t q = 0; q < n; ++q) {
        place[q] = b[3 * q] * corner[0] + b[3 * q + 1] * corner[1] + b[3 * q + 2] * corner[2];
        weight[q] = b[3 * q + std::size_t(k)] * rule.weights.data()[q] * scale[k];
      }
    }
    triangle_ = &g;
    rule_ = &rule;
  }

  const TriangleGeometry<double>* triangle_ = nullptr;
  const TriangleRule* rule_ = nullptr;
  std::vector<double> storage_;
};

/// Spreads the low 21 bits of v to every third bit.
inline std::uint64_t spread_bits(std::uint64_t v) {
  v = (v | v << 32) & 0x1f00000000ffffull;
  v = (v | v << 16) & 0x1f0000ff0000ffull;
  v = (v | v << 8) & 0x100f00f00f00f00full;
  v = (v | v << 4) & 0x10c30c30c30c30c3ull;
  return (v | v << 2) & 0x1249249249249249ull;
}

/// Indices of the points along Morton's curve: neighbours in it are neighbours in space, so a panel's points are close.
inline std::vector<std::int32_t> morton_order(const std::vector<Eigen::Vector3d>& points) {
  Eigen::Vector3d low = points.front(), high = points.front();
  for (const auto& p : points) {
    low = low.cwiseMin(p);
    high = high.cwiseMax(p);
  }
  const double cells = 2097151 / std::max((high - low).maxCoeff(), std::numeric_limits<double>::min());
  std::vector<std::uint64_t> code(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const Eigen::Vector3d cell = (points[i] - low) * cells;
    code[i] = spread_bits(static_cast<std::uint64_t>(cell[0])) | spread_bits(static_cast<std::uint64_t>(cell[1])) << 1 |
              spread_bits(static_cast<std::uint64_t>(cell[2])) << 2;
  }
  std::vector<std::int32_t> order(points.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](auto a, auto b) { return code[a] < code[b]; });
  return order;
}

template <class Block, class Real>
void add_block(const Block& block, Real* out) {
  for (Eigen::Index e = 0; e < Block::SizeAtCompileTime; ++e) {
    out[e * Eigen::Index(kPanel)] +=
        static_cast<Real>(block(e / Block::ColsAtCompileTime, e % Block::ColsAtCompileTime));
  }
}

}  // namespace detail

/// Up to kPanel field points.
template <class Kernel>
struct Collocation<Kernel>::Panel {
  PointPanel points;
  std::int32_t vertex[kPanel];
  std::size_t count;

  Panel(const std::vector<Eigen::Vector3d>& vertices, std::span<const std::int32_t> rows) : count(rows.size()) {
    for (std::size_t p = 0; p < kPanel; ++p) {
      vertex[p] = rows[std::min(p, count - 1)];
      points.x[p] = vertices[vertex[p]][0];
      points.y[p] = vertices[vertex[p]][1];
      points.z[p] = vertices[vertex[p]][2];
    }
  }
  PanelMask mask() const { return (1u << count) - 1u; }
};

/// The entries of one panel of rows in the columns asked for.
template <class Kernel>
template <class Real>
struct Collocation<Kernel>::ColumnBlock {
  static constexpr std::size_t entries = components * components;
  AssemblyCounts counts;

  /// `slot_of` is by vertex, -1 for those that are not asked for.
  void prepare(std::span<const std::int32_t> slot_of, std::size_t slots) {
    slot_of_ = slot_of;
    slots_ = slots;
    counts = {};
    values_.zero((slots + 1) * entries * kPanel);  // one more slot takes what is not asked for
  }
  Real* slot(std::size_t k) { return values_.data + k * entries * kPanel; }
  Real* at(std::int32_t vertex) {
    const std::int32_t k = slot_of_[vertex];
    return slot(k < 0 ? slots_ : static_cast<std::size_t>(k));
  }
  typename Kernel::Block entry(std::size_t k, std::size_t p) {
    typename Kernel::Block block;
    for (int e = 0; e < int(entries); ++e) block(e / components, e % components) = slot(k)[e * kPanel + p];
    return block;
  }

 private:
  std::span<const std::int32_t> slot_of_;
  std::size_t slots_ = 0;
  detail::AlignedBuffer<Real> values_;  ///< [slot][entry][point]
};

/// Which points of a panel are near a triangle, and the Gauss rule that serves the others: one for each half where a
/// vector holds half a panel.
template <class Kernel>
struct Collocation<Kernel>::Reach {
  struct Far {
    PanelMask mask;
    const TriangleRule* rule;
  };
  PanelMask near;
  Far far[2];
};

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
      integral_(kernel, std::max(smallest_tolerance, options.tolerance / 2)),
      single_(options.tolerance >= 1e-5) {
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
typename Collocation<Kernel>::Reach Collocation<Kernel>::reach(const Panel& panel, const SourceTriangle& triangle,
                                                               const RuleLadder& ladder) {
  constexpr PanelMask first_half = (1u << kPanel / 2) - 1u;
  const PanelReach found = panel_reach(panel.points, triangle.centroid, ladder.near_ratio2() * triangle.radius2);
  const PanelMask far = ~found.near & panel.mask();
  const auto rule = [&](double closest2) {  // rounding must not bring it below the last rung
    return ladder.rule(std::max(closest2 / triangle.radius2, ladder.near_ratio2()));
  };
  const auto [first, second] = found.closest2;
  Reach split{found.near & panel.mask(), {{far, rule(std::min(first, second))}, {0, nullptr}}};
  if constexpr (std::is_same_v<Real, double>) {
    const TriangleRule *of_first = rule(first), *of_second = rule(second);
    if (of_first != of_second) {
      split.far[0] = {far & first_half, of_first};
      split.far[1] = {far & ~first_half, of_second};
    }
  }
  return split;
}

template <class Kernel>
template <class Real>
void Collocation<Kernel>::add_triangle(const Panel& panel, Index t, detail::GaussPoints& gauss,
                                       ColumnBlock<Real>& block) const {
  const SourceTriangle& triangle = sources_[t];
  const auto& v = triangles_[t];
  Real* const out[3] = {block.at(v[0]), block.at(v[1]), block.at(v[2])};
  const Reach split = reach<Real>(panel, triangle, integral_.double_layer_rules());
  block.counts.pairs += panel.count;
  block.counts.near += static_cast<unsigned>(std::popcount(split.near));

  for (const auto& [mask, rule] : split.far) {
    if (mask == 0) continue;
    const SourcePoints points = gauss.of(triangle.geometry, *rule, {1, 1, 1});
    add_double_layer(integral_.kernel(), panel.points, mask, points, triangle.geometry.normal, out);
  }
  for (PanelMask near = split.near; near != 0; near &= near - 1) {
    const std::size_t p = static_cast<std::size_t>(std::countr_zero(near));
    const auto blocks = integral_.double_layer(triangle, panel.points.point(p));
    for (int c = 0; c < 3; ++c) {
      if (v[c] != panel.vertex[p])
        detail::add_block(blocks[c], out[c] + p);  // the diagonal comes from rigid translation
    }
  }
}

template <class Kernel>
void Collocation<Kernel>::add_single_layer_of(const Panel& panel, Index t, const std::vector<double>& value,
                                              detail::GaussPoints& gauss, ColumnBlock<double>& block) const {
  const SourceTriangle& triangle = sources_[t];
  const auto& v = triangles_[t];
  const Eigen::Vector3d density(value[v[0]], value[v[1]], value[v[2]]);
  const Reach split = reach<double>(panel, triangle, integral_.single_layer_rules());
  for (const auto& [mask, rule] : split.far) {
    if (mask == 0) continue;
    const SourcePoints points = gauss.of(triangle.geometry, *rule, density);
    add_single_layer(integral_.kernel(), panel.points, mask, points, block.slot(0));
  }
  for (PanelMask near = split.near; near != 0; near &= near - 1) {
    const std::size_t p = static_cast<std::size_t>(std::countr_zero(near));
    const auto blocks = integral_.single_layer(triangle, panel.points.point(p));
    const typename Kernel::Block sum = blocks[0] * density[0] + blocks[1] * density[1] + blocks[2] * density[2];
    detail::add_block(sum, block.slot(0) + p);
  }
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
    for (Index t = 0; t < Index(triangles_.size()); ++t) add_triangle(panel, t, gauss, block);
    counts[k] = block.counts;
    store_rows(panel, block, H);
  });
}

template <class Kernel>
RowMajorMatrix Collocation<Kernel>::double_layer_matrix(const Progress& progress, AssemblyCounts* counts) const {
  RowMajorMatrix H(components * node_count(), components * node_count());
  std::vector<AssemblyCounts> counted(panel_count());
  single_ ? fill<float>(H, progress, counted) : fill<double>(H, progress, counted);
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
  if (!single_) {
    make_panels<double>(rows, columns, store);
    return;
  }
  const std::size_t size = columns.size() * ColumnBlock<float>::entries * kPanel;
  thread_local detail::AlignedBuffer<double> wide;
  wide.zero(size);
  make_panels<float>(rows, columns, [&](std::size_t first, std::size_t count, const float* entries) {
    std::copy_n(entries, size, wide.data);
    store(first, count, wide.data);
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
  const std::vector<std::int32_t> triangles = triangles_around(support, slots);
  Eigen::MatrixXd G(components * node_count(), components);
  for_each_panel<double>({}, "", [&](Index, const Panel& panel, ColumnBlock<double>& block) {
    block.prepare({}, 0);
    detail::GaussPoints gauss;
    for (const std::int32_t t : triangles) add_single_layer_of(panel, t, value, gauss, block);
    for (std::size_t p = 0; p < panel.count; ++p) {
      G.template block<components, components>(components * Index(panel.vertex[p]), 0) = block.entry(0, p) / scale_;
    }
  });
  return G;
}

}  // namespace skinbem
