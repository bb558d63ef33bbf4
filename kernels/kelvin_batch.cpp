// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/kernels/kelvin_batch.hpp>

#include <algorithm>
#include <bit>
#include <type_traits>
#include <utility>

// Vectors of unknown size cannot be members of a struct; those targets use NEON or scalar code instead.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "skinbem/kernels/kelvin_batch.cpp"
// clang-format off
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace skinbem {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;
using D64 = hn::CappedTag<double, kPanel>;
using D32 = hn::CappedTag<float, kPanel>;
using V64 = hn::Vec<D64>;
using V32 = hn::Vec<D32>;

template <class D>
HWY_INLINE hn::Mask<D> mask_of(D d, PanelMask lanes) {
  const std::uint8_t bits[8] = {static_cast<std::uint8_t>(lanes), static_cast<std::uint8_t>(lanes >> 8)};
  return hn::LoadMaskBits(d, bits);
}

/// Adds the lanes of the mask to the sums.
template <class D>
HWY_INLINE void add(D d, hn::Mask<D> mask, hn::Vec<D> value, hn::TFromD<D>* HWY_RESTRICT out) {
  hn::Store(hn::Add(hn::Load(d, out), hn::IfThenElseZero(mask, value)), d, out);
}

/// 1/sqrt(r2) to a few units of the last place, in half the time of a square root and a division: the hardware's 12
/// bits, then in double a third-order step (36 bits) and a second-order one, in float the latter alone. In double r2
/// must lie in the range of float.
HWY_INLINE V64 inverse_root(D64 d, V64 r2) {
  const hn::Rebind<float, D64> f;
  V64 y = hn::PromoteTo(d, hn::ApproximateReciprocalSqrt(hn::DemoteTo(f, r2)));
  const V64 one = hn::Set(d, 1.0);
  V64 e = hn::NegMulAdd(hn::Mul(r2, y), y, one);
  y = hn::MulAdd(hn::Mul(y, e), hn::MulAdd(e, hn::Set(d, 0.375), hn::Set(d, 0.5)), y);
  e = hn::NegMulAdd(hn::Mul(r2, y), y, one);
  return hn::MulAdd(hn::Mul(y, e), hn::Set(d, 0.5), y);
}

HWY_INLINE V32 inverse_root(D32 d, V32 r2) {
  const V32 y = hn::ApproximateReciprocalSqrt(r2);
  const V32 e = hn::NegMulAdd(hn::Mul(r2, y), y, hn::Set(d, 1.0f));
  return hn::MulAdd(hn::Mul(y, e), hn::Set(d, 0.5f), y);
}

/// The sums over the Gauss points against one hat function: w r / r^3 and w r r^T / r^5.
template <class V>
struct Sums {
  V x, y, z, xx, xy, xz, yy, yz, zz;
};

template <class D>
HWY_INLINE Sums<hn::Vec<D>> zero(D d) {
  const auto o = hn::Zero(d);
  return {o, o, o, o, o, o, o, o, o};
}

/// From the moments to the three by three entries (see Kelvin::double_layer_integral): put(value, where).
template <class D, class V, class Put>
HWY_INLINE void put_traction(D d, const Kelvin<double>& kernel, const double* normal, V height, const Sums<V>& s,
                             const Put& put) {
  using T = hn::TFromD<D>;
  const double c = kernel.double_layer_factor();
  const double slip_factor = c * (1 - 2 * kernel.poisson);
  const V nx = hn::Set(d, static_cast<T>(slip_factor * normal[0]));
  const V ny = hn::Set(d, static_cast<T>(slip_factor * normal[1]));
  const V nz = hn::Set(d, static_cast<T>(slip_factor * normal[2]));
  const V h3 = hn::Mul(height, hn::Set(d, static_cast<T>(-3 * c)));
  const V slip = hn::Set(d, static_cast<T>(slip_factor));
  const V isotropic = hn::Mul(hn::Mul(height, slip), hn::Add(hn::Add(s.xx, s.yy), s.zz));
  const V skew_xy = hn::MulSub(s.x, ny, hn::Mul(s.y, nx));
  const V skew_xz = hn::MulSub(s.x, nz, hn::Mul(s.z, nx));
  const V skew_yz = hn::MulSub(s.y, nz, hn::Mul(s.z, ny));
  put(hn::MulSub(h3, s.xx, isotropic), 0 * kPanel);
  put(hn::MulAdd(h3, s.xy, skew_xy), 1 * kPanel);
  put(hn::MulAdd(h3, s.xz, skew_xz), 2 * kPanel);
  put(hn::MulSub(h3, s.xy, skew_xy), 3 * kPanel);
  put(hn::MulSub(h3, s.yy, isotropic), 4 * kPanel);
  put(hn::MulAdd(h3, s.yz, skew_yz), 5 * kPanel);
  put(hn::MulSub(h3, s.xz, skew_xz), 6 * kPanel);
  put(hn::MulSub(h3, s.yz, skew_yz), 7 * kPanel);
  put(hn::MulSub(h3, s.zz, isotropic), 8 * kPanel);
}

/// Coordinates of one vector of field points; any common origin.
template <class V>
struct Field {
  V x, y, z;
};

template <class D, class T = hn::TFromD<D>, class V = hn::Vec<D>>
HWY_INLINE void double_layer_of_vector(D d, const Kelvin<double>& kernel, const Field<V>& at, PanelMask lanes,
                                       std::size_t count, const T* HWY_RESTRICT const* source,
                                       const double* HWY_RESTRICT normal, T* const* out) {
  Sums<V> a = zero(d), b = zero(d), c = zero(d);
  for (std::size_t q = 0; q < count; ++q) {
    const V rx = hn::Sub(hn::Set(d, source[0][q]), at.x);
    const V ry = hn::Sub(hn::Set(d, source[1][q]), at.y);
    const V rz = hn::Sub(hn::Set(d, source[2][q]), at.z);
    const V r2 = hn::MulAdd(rz, rz, hn::MulAdd(ry, ry, hn::Mul(rx, rx)));
    const V r1 = inverse_root(d, r2);
    const V r_2 = hn::Mul(r1, r1);
    const V r3 = hn::Mul(r1, r_2);
    const V wa = hn::Set(d, source[3][q]);
    const V wb = hn::Set(d, source[4][q]);
    const V wc = hn::Set(d, source[5][q]);
    const auto spread = [&](V value, V Sums<V>::*member) HWY_ATTR {
      a.*member = hn::MulAdd(wa, value, a.*member);
      b.*member = hn::MulAdd(wb, value, b.*member);
      c.*member = hn::MulAdd(wc, value, c.*member);
    };
    const V vx = hn::Mul(rx, r3);
    const V vy = hn::Mul(ry, r3);
    const V vz = hn::Mul(rz, r3);
    spread(vx, &Sums<V>::x);
    spread(vy, &Sums<V>::y);
    spread(vz, &Sums<V>::z);
    const V px = hn::Mul(vx, r_2);
    const V py = hn::Mul(vy, r_2);
    spread(hn::Mul(px, rx), &Sums<V>::xx);
    spread(hn::Mul(px, ry), &Sums<V>::xy);
    spread(hn::Mul(px, rz), &Sums<V>::xz);
    spread(hn::Mul(py, ry), &Sums<V>::yy);
    spread(hn::Mul(py, rz), &Sums<V>::yz);
    spread(hn::Mul(hn::Mul(vz, r_2), rz), &Sums<V>::zz);
  }
  // the height (y - x).n is the same for every y of the triangle
  const auto component = [&](int k) HWY_ATTR { return hn::Set(d, static_cast<T>(normal[k])); };
  const V height = hn::MulAdd(hn::Sub(hn::Set(d, source[2][0]), at.z), component(2),
                              hn::MulAdd(hn::Sub(hn::Set(d, source[1][0]), at.y), component(1),
                                         hn::Mul(hn::Sub(hn::Set(d, source[0][0]), at.x), component(0))));
  const auto mask = mask_of(d, lanes);
  const auto add_to = [&](const Sums<V>& sums, T* HWY_RESTRICT to) HWY_ATTR {
    put_traction(d, kernel, normal, height, sums,
                 [&](V value, std::size_t k) HWY_ATTR { add(d, mask, value, to + k); });
  };
  add_to(a, out[0]);
  add_to(b, out[1]);
  add_to(c, out[2]);
}

/// Calls f(first, lanes) for each vector of the panel that has a point in the mask; bit 0 of lanes is point `first`.
template <class D, class F>
HWY_INLINE void for_each_vector(D d, PanelMask mask, F f) {
  const std::size_t step = hn::Lanes(d);
  for (std::size_t first = 0; first < kPanel; first += step) {
    const PanelMask lanes = (mask >> first) & ((1u << step) - 1u);
    if (lanes != 0) f(first, lanes);
  }
}

void double_layer_of_panel(const Kelvin<double>& kernel, const PointPanel& panel, PanelMask mask,
                           const SourcePoints& source, const double* normal, double* const* out) {
  const D64 d;
  const double* const sources[6] = {source.x,          source.y,          source.z,
                                    source.weights[0], source.weights[1], source.weights[2]};
  for_each_vector(d, mask, [&](std::size_t first, PanelMask lanes) HWY_ATTR {
    const Field<hn::Vec<D64>> at = {hn::Load(d, panel.x + first), hn::Load(d, panel.y + first),
                                    hn::Load(d, panel.z + first)};
    double* const shifted[3] = {out[0] + first, out[1] + first, out[2] + first};
    double_layer_of_vector(d, kernel, at, lanes, source.count, sources, normal, shifted);
  });
}

/// In single precision relative to the first Gauss point, so that only r is rounded, not the position in space.
void double_layer_of_panel_f32(const Kelvin<double>& kernel, const PointPanel& panel, PanelMask mask,
                               const SourcePoints& source, const double* normal, float* const* out) {
  constexpr std::size_t kMost = 64;  // points at once
  const D32 d;
  alignas(64) float local[6][kMost];
  alignas(64) float at[3][kPanel];
  const double origin[3] = {source.x[0], source.y[0], source.z[0]};
  const double* const points[3] = {source.x, source.y, source.z};
  const double* const field[3] = {panel.x, panel.y, panel.z};
  const float* const sources[6] = {local[0], local[1], local[2], local[3], local[4], local[5]};
  for (int k = 0; k < 3; ++k) {
    for (std::size_t p = 0; p < kPanel; ++p) at[k][p] = static_cast<float>(field[k][p] - origin[k]);
  }
  for (std::size_t done = 0; done < source.count; done += kMost) {
    const std::size_t count = std::min(kMost, source.count - done);
    for (int k = 0; k < 3; ++k) {
      for (std::size_t q = 0; q < count; ++q) {
        local[k][q] = static_cast<float>(points[k][done + q] - origin[k]);
        local[3 + k][q] = static_cast<float>(source.weights[k][done + q]);
      }
    }
    for_each_vector(d, mask, [&](std::size_t first, PanelMask lanes) HWY_ATTR {
      const Field<V32> x = {hn::Load(d, at[0] + first), hn::Load(d, at[1] + first), hn::Load(d, at[2] + first)};
      float* const shifted[3] = {out[0] + first, out[1] + first, out[2] + first};
      double_layer_of_vector(d, kernel, x, lanes, count, sources, normal, shifted);
    });
  }
}

void single_layer_of_panel(const Kelvin<double>& kernel, const PointPanel& panel, PanelMask mask,
                           const SourcePoints& source, double* out_of_panel) {
  const D64 d;
  using V = hn::Vec<D64>;
  for_each_vector(d, mask, [&](std::size_t first, PanelMask lanes) HWY_ATTR {
    const V x = hn::Load(d, panel.x + first);
    const V y = hn::Load(d, panel.y + first);
    const V z = hn::Load(d, panel.z + first);
    V xx = hn::Zero(d), xy = xx, xz = xx, yy = xx, yz = xx, zz = xx;
    for (std::size_t q = 0; q < source.count; ++q) {
      const V rx = hn::Sub(hn::Set(d, source.x[q]), x);
      const V ry = hn::Sub(hn::Set(d, source.y[q]), y);
      const V rz = hn::Sub(hn::Set(d, source.z[q]), z);
      const V r2 = hn::MulAdd(rz, rz, hn::MulAdd(ry, ry, hn::Mul(rx, rx)));
      const V r1 = inverse_root(d, r2);
      const V w = hn::Set(d, source.weights[0][q] + source.weights[1][q] + source.weights[2][q]);
      const V w3 = hn::Mul(hn::Mul(w, r1), hn::Mul(r1, r1));
      const V px = hn::Mul(w3, rx);
      const V py = hn::Mul(w3, ry);
      xx = hn::MulAdd(px, rx, xx);
      xy = hn::MulAdd(px, ry, xy);
      xz = hn::MulAdd(px, rz, xz);
      yy = hn::MulAdd(py, ry, yy);
      yz = hn::MulAdd(py, rz, yz);
      zz = hn::MulAdd(hn::Mul(w3, rz), rz, zz);
    }
    const double c = kernel.single_layer_factor();
    const V factor = hn::Set(d, c);
    // the trace of w r r^T / r^3 is w / r
    const V isotropic = hn::Mul(hn::Add(hn::Add(xx, yy), zz), hn::Set(d, c * (3 - 4 * kernel.poisson)));
    const auto used = mask_of(d, lanes);
    double* HWY_RESTRICT out = out_of_panel + first;
    add(d, used, hn::MulAdd(xx, factor, isotropic), out + 0 * kPanel);
    add(d, used, hn::Mul(xy, factor), out + 1 * kPanel);
    add(d, used, hn::Mul(xz, factor), out + 2 * kPanel);
    add(d, used, hn::Mul(xy, factor), out + 3 * kPanel);
    add(d, used, hn::MulAdd(yy, factor, isotropic), out + 4 * kPanel);
    add(d, used, hn::Mul(yz, factor), out + 5 * kPanel);
    add(d, used, hn::Mul(xz, factor), out + 6 * kPanel);
    add(d, used, hn::Mul(yz, factor), out + 7 * kPanel);
    add(d, used, hn::MulAdd(zz, factor, isotropic), out + 8 * kPanel);
  });
}

void dipoles_of_panel(const Kelvin<double>& kernel, const PointPanel& panel, const Dipoles& dipoles, double* to) {
  const D64 d;
  using V = hn::Vec<D64>;
  for (std::size_t first = 0; first < kPanel; first += hn::Lanes(d)) {
    const V x = hn::Load(d, panel.x + first);
    const V y = hn::Load(d, panel.y + first);
    const V z = hn::Load(d, panel.z + first);
    for (std::size_t q = 0; q < dipoles.count; ++q) {
      const double normal[3] = {dipoles.normal[0][q], dipoles.normal[1][q], dipoles.normal[2][q]};
      const V rx = hn::Sub(hn::Set(d, dipoles.x[q]), x);
      const V ry = hn::Sub(hn::Set(d, dipoles.y[q]), y);
      const V rz = hn::Sub(hn::Set(d, dipoles.z[q]), z);
      const V r1 = inverse_root(d, hn::MulAdd(rz, rz, hn::MulAdd(ry, ry, hn::Mul(rx, rx))));
      const V r_2 = hn::Mul(r1, r1);
      const V r3 = hn::Mul(r1, r_2);
      Sums<V> s;
      s.x = hn::Mul(rx, r3);
      s.y = hn::Mul(ry, r3);
      s.z = hn::Mul(rz, r3);
      const V px = hn::Mul(s.x, r_2);
      const V py = hn::Mul(s.y, r_2);
      s.xx = hn::Mul(px, rx);
      s.xy = hn::Mul(px, ry);
      s.xz = hn::Mul(px, rz);
      s.yy = hn::Mul(py, ry);
      s.yz = hn::Mul(py, rz);
      s.zz = hn::Mul(hn::Mul(s.z, r_2), rz);
      const V height = hn::MulAdd(rz, hn::Set(d, normal[2]),
                                  hn::MulAdd(ry, hn::Set(d, normal[1]), hn::Mul(rx, hn::Set(d, normal[0]))));
      double* const out = to + q * 9 * kPanel + first;
      put_traction(d, kernel, normal, height, s,
                   [&](V value, std::size_t k) HWY_ATTR { hn::Store(value, d, out + k); });
    }
  }
}

/// One vector of FieldRows.
template <class D>
struct RowVector {
  hn::Vec<D> x, y, z;
  hn::Mask<D> is[3];  ///< component i

  RowVector(D d, const FieldRows<hn::TFromD<D>>& rows, std::size_t first)
      : x(hn::Load(d, rows.x + first)), y(hn::Load(d, rows.y + first)), z(hn::Load(d, rows.z + first)) {
    const auto component = hn::Load(d, rows.component + first);
    for (int i = 0; i < 3; ++i) is[i] = hn::Eq(component, hn::Set(d, static_cast<hn::TFromD<D>>(i)));
  }
};

/// The columns of `count` dipoles, of each the components of kSet, for one vector of rows; columns are `stride` apart.
template <unsigned kSet, class D, class T = hn::TFromD<D>>
HWY_INLINE void dipole_columns(D d, const Kelvin<double>& kernel, const RowVector<D>& at,
                               const DipoleColumns<T>& dipoles, std::size_t begin, std::size_t count,
                               std::size_t stride, T* HWY_RESTRICT out) {
  using V = hn::Vec<D>;
  const double c = kernel.double_layer_factor();
  const V tensile = hn::Set(d, static_cast<T>(-3 * c));
  const V slip = hn::Set(d, static_cast<T>(c * (1 - 2 * kernel.poisson)));
  const auto component_of_row = [&](V x, V y, V z)
                                    HWY_ATTR { return hn::IfThenElse(at.is[2], z, hn::IfThenElse(at.is[1], y, x)); };
  for (std::size_t q = begin; q < begin + count; ++q) {
    const V n[3] = {hn::Set(d, dipoles.normal[0][q]), hn::Set(d, dipoles.normal[1][q]),
                    hn::Set(d, dipoles.normal[2][q])};
    const V r[3] = {hn::Sub(hn::Set(d, dipoles.x[q]), at.x), hn::Sub(hn::Set(d, dipoles.y[q]), at.y),
                    hn::Sub(hn::Set(d, dipoles.z[q]), at.z)};
    const V r1 = inverse_root(d, hn::MulAdd(r[2], r[2], hn::MulAdd(r[1], r[1], hn::Mul(r[0], r[0]))));
    const V r_2 = hn::Mul(r1, r1);
    const V r3 = hn::Mul(r1, r_2);
    const V height = hn::MulAdd(r[2], n[2], hn::MulAdd(r[1], n[1], hn::Mul(r[0], n[0])));
    const V ri = component_of_row(r[0], r[1], r[2]);
    const V ni = component_of_row(n[0], n[1], n[2]);
    // T_ij = along r_j + across n_j - d_ij same
    const V slip3 = hn::Mul(slip, r3);
    const V height5 = hn::Mul(hn::Mul(hn::Mul(tensile, r3), r_2), height);
    const V along = hn::MulSub(height5, ri, hn::Mul(slip3, ni));
    const V across = hn::Mul(slip3, ri);
    const V same = hn::Mul(slip3, height);
    for (unsigned j = 0; j < 3; ++j) {
      if (!(kSet >> j & 1)) continue;
      const V value = hn::MulAdd(along, r[j], hn::Mul(across, n[j]));
      hn::Store(hn::IfThenElse(at.is[j], hn::Sub(value, same), value), d, out);
      out += stride;
    }
  }
}

template <class D, class T = hn::TFromD<D>>
HWY_INLINE void make_dipole_matrix(D d, const Kelvin<double>& kernel, const FieldRows<T>& rows,
                                   const DipoleColumns<T>& dipoles, T* out) {
  for (std::size_t first = 0; first < rows.count; first += hn::Lanes(d)) {
    const RowVector<D> at(d, rows, first);
    T* to = out + first;
    std::size_t q = 0;
    const auto columns = [&](auto set) HWY_ATTR {
      constexpr unsigned kSet = decltype(set)::value;
      const std::size_t count = dipoles.with[kSet];
      dipole_columns<kSet>(d, kernel, at, dipoles, q, count, rows.count, to);
      q += count;
      to += count * static_cast<std::size_t>(std::popcount(kSet)) * rows.count;
    };
    [&]<unsigned... kSets>(std::integer_sequence<unsigned, kSets...>) HWY_ATTR {
      (columns(std::integral_constant<unsigned, kSets>()), ...);
    }
    (std::make_integer_sequence<unsigned, 8>());
  }
}

void dipole_matrix_f32(const Kelvin<double>& kernel, const FieldRows<float>& rows, const DipoleColumns<float>& dipoles,
                       float* out) {
  make_dipole_matrix(D32(), kernel, rows, dipoles, out);
}

void dipole_matrix_f64(const Kelvin<double>& kernel, const FieldRows<double>& rows,
                       const DipoleColumns<double>& dipoles, double* out) {
  make_dipole_matrix(D64(), kernel, rows, dipoles, out);
}

}  // namespace HWY_NAMESPACE
}  // namespace skinbem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skinbem {

HWY_EXPORT(double_layer_of_panel);
HWY_EXPORT(double_layer_of_panel_f32);
HWY_EXPORT(single_layer_of_panel);
HWY_EXPORT(dipoles_of_panel);
HWY_EXPORT(dipole_matrix_f32);
HWY_EXPORT(dipole_matrix_f64);

void add_double_layer(const Kelvin<double>& kernel, const PointPanel& panel, PanelMask mask, const SourcePoints& source,
                      const Eigen::Vector3d& n, double* const out[3]) {
  HWY_DYNAMIC_DISPATCH(double_layer_of_panel)(kernel, panel, mask, source, n.data(), out);
}

void add_double_layer(const Kelvin<double>& kernel, const PointPanel& panel, PanelMask mask, const SourcePoints& source,
                      const Eigen::Vector3d& n, float* const out[3]) {
  HWY_DYNAMIC_DISPATCH(double_layer_of_panel_f32)(kernel, panel, mask, source, n.data(), out);
}

void add_single_layer(const Kelvin<double>& kernel, const PointPanel& panel, PanelMask mask, const SourcePoints& source,
                      double* out) {
  HWY_DYNAMIC_DISPATCH(single_layer_of_panel)(kernel, panel, mask, source, out);
}

void double_layer_of_dipoles(const Kelvin<double>& kernel, const PointPanel& panel, const Dipoles& dipoles,
                             double* out) {
  HWY_DYNAMIC_DISPATCH(dipoles_of_panel)(kernel, panel, dipoles, out);
}

void dipole_matrix(const Kelvin<double>& kernel, const FieldRows<float>& rows, const DipoleColumns<float>& dipoles,
                   float* out) {
  HWY_DYNAMIC_DISPATCH(dipole_matrix_f32)(kernel, rows, dipoles, out);
}

void dipole_matrix(const Kelvin<double>& kernel, const FieldRows<double>& rows, const DipoleColumns<double>& dipoles,
                   double* out) {
  HWY_DYNAMIC_DISPATCH(dipole_matrix_f64)(kernel, rows, dipoles, out);
}

const char* instruction_set() {
  const std::int64_t supported = hwy::SupportedTargets() & HWY_TARGETS;
  return hwy::TargetName(supported & -supported);
}

}  // namespace skinbem
#endif
