// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/kernels/kelvin_batch.hpp>

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
using D = hn::CappedTag<double, kPanel>;
using V = hn::Vec<D>;

HWY_INLINE hn::Mask<D> mask_of(D d, PanelMask lanes) {
  const std::uint8_t bits[8] = {static_cast<std::uint8_t>(lanes), static_cast<std::uint8_t>(lanes >> 8)};
  return hn::LoadMaskBits(d, bits);
}

HWY_INLINE void add(D d, hn::Mask<D> mask, V value, double* HWY_RESTRICT out) {
  hn::Store(hn::Add(hn::Load(d, out), hn::IfThenElseZero(mask, value)), d, out);
}

/// 1/sqrt(r2) to a few units of the last place: the hardware's 12 bits, a third-order step (36 bits) and a second-order
/// one. Half the time of a square root and a division. r2 must lie in the range of float.
HWY_INLINE V inverse_root(D d, V r2) {
  const hn::Rebind<float, D> f;
  V y = hn::PromoteTo(d, hn::ApproximateReciprocalSqrt(hn::DemoteTo(f, r2)));
  const V one = hn::Set(d, 1.0);
  V e = hn::NegMulAdd(hn::Mul(r2, y), y, one);
  y = hn::MulAdd(hn::Mul(y, e), hn::MulAdd(e, hn::Set(d, 0.375), hn::Set(d, 0.5)), y);
  e = hn::NegMulAdd(hn::Mul(r2, y), y, one);
  return hn::MulAdd(hn::Mul(y, e), hn::Set(d, 0.5), y);
}

/// The sums over the Gauss points against one hat function: w r / r^3 and w r r^T / r^5.
struct Sums {
  V x, y, z, xx, xy, xz, yy, yz, zz;
};

HWY_INLINE Sums zero(D d) {
  const V o = hn::Zero(d);
  return {o, o, o, o, o, o, o, o, o};
}

/// From the moments to the three by three entries (see Kelvin::double_layer_integral), added to `out`.
HWY_INLINE void add_traction(D d, hn::Mask<D> mask, const Kelvin<double>& kernel, const double* normal, V height,
                             const Sums& s, double* HWY_RESTRICT out) {
  const double c = kernel.double_layer_factor();
  const V slip = hn::Set(d, c * (1 - 2 * kernel.poisson));
  const V nx = hn::Mul(slip, hn::Set(d, normal[0]));
  const V ny = hn::Mul(slip, hn::Set(d, normal[1]));
  const V nz = hn::Mul(slip, hn::Set(d, normal[2]));
  const V h3 = hn::Mul(height, hn::Set(d, -3 * c));
  const V isotropic = hn::Mul(hn::Mul(height, slip), hn::Add(hn::Add(s.xx, s.yy), s.zz));
  const V skew_xy = hn::MulSub(s.x, ny, hn::Mul(s.y, nx));
  const V skew_xz = hn::MulSub(s.x, nz, hn::Mul(s.z, nx));
  const V skew_yz = hn::MulSub(s.y, nz, hn::Mul(s.z, ny));
  add(d, mask, hn::MulSub(h3, s.xx, isotropic), out + 0 * kPanel);
  add(d, mask, hn::MulAdd(h3, s.xy, skew_xy), out + 1 * kPanel);
  add(d, mask, hn::MulAdd(h3, s.xz, skew_xz), out + 2 * kPanel);
  add(d, mask, hn::MulSub(h3, s.xy, skew_xy), out + 3 * kPanel);
  add(d, mask, hn::MulSub(h3, s.yy, isotropic), out + 4 * kPanel);
  add(d, mask, hn::MulAdd(h3, s.yz, skew_yz), out + 5 * kPanel);
  add(d, mask, hn::MulSub(h3, s.xz, skew_xz), out + 6 * kPanel);
  add(d, mask, hn::MulSub(h3, s.yz, skew_yz), out + 7 * kPanel);
  add(d, mask, hn::MulSub(h3, s.zz, isotropic), out + 8 * kPanel);
}

void double_layer_of_vector(const Kelvin<double>& kernel, const PointPanel& panel, std::size_t first, PanelMask lanes,
                            const SourcePoints& source, const double* HWY_RESTRICT normal, double* const* out) {
  const D d;
  const V x = hn::Load(d, panel.x + first);
  const V y = hn::Load(d, panel.y + first);
  const V z = hn::Load(d, panel.z + first);
  Sums a = zero(d), b = zero(d), c = zero(d);
  for (std::size_t q = 0; q < source.count; ++q) {
    const V rx = hn::Sub(hn::Set(d, source.x[q]), x);
    const V ry = hn::Sub(hn::Set(d, source.y[q]), y);
    const V rz = hn::Sub(hn::Set(d, source.z[q]), z);
    const V r2 = hn::MulAdd(rz, rz, hn::MulAdd(ry, ry, hn::Mul(rx, rx)));
    const V r1 = inverse_root(d, r2);
    const V r_2 = hn::Mul(r1, r1);
    const V r3 = hn::Mul(r1, r_2);
    const V wa = hn::Set(d, source.weights[0][q]);
    const V wb = hn::Set(d, source.weights[1][q]);
    const V wc = hn::Set(d, source.weights[2][q]);
    const auto spread = [&](V value, V Sums::*member) HWY_ATTR {
      a.*member = hn::MulAdd(wa, value, a.*member);
      b.*member = hn::MulAdd(wb, value, b.*member);
      c.*member = hn::MulAdd(wc, value, c.*member);
    };
    const V vx = hn::Mul(rx, r3);
    const V vy = hn::Mul(ry, r3);
    const V vz = hn::Mul(rz, r3);
    spread(vx, &Sums::x);
    spread(vy, &Sums::y);
    spread(vz, &Sums::z);
    const V px = hn::Mul(vx, r_2);
    const V py = hn::Mul(vy, r_2);
    spread(hn::Mul(px, rx), &Sums::xx);
    spread(hn::Mul(px, ry), &Sums::xy);
    spread(hn::Mul(px, rz), &Sums::xz);
    spread(hn::Mul(py, ry), &Sums::yy);
    spread(hn::Mul(py, rz), &Sums::yz);
    spread(hn::Mul(hn::Mul(vz, r_2), rz), &Sums::zz);
  }
  // the height (y - x).n is the same for every y of the triangle
  const V height = hn::MulAdd(hn::Sub(hn::Set(d, source.z[0]), z), hn::Set(d, normal[2]),
                              hn::MulAdd(hn::Sub(hn::Set(d, source.y[0]), y), hn::Set(d, normal[1]),
                                         hn::Mul(hn::Sub(hn::Set(d, source.x[0]), x), hn::Set(d, normal[0]))));
  const auto mask = mask_of(d, lanes);
  add_traction(d, mask, kernel, normal, height, a, out[0] + first);
  add_traction(d, mask, kernel, normal, height, b, out[1] + first);
  add_traction(d, mask, kernel, normal, height, c, out[2] + first);
}

void single_layer_of_vector(const Kelvin<double>& kernel, const PointPanel& panel, std::size_t first, PanelMask lanes,
                            const SourcePoints& source, double* HWY_RESTRICT out) {
  const D d;
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
  const auto mask = mask_of(d, lanes);
  out += first;
  add(d, mask, hn::MulAdd(xx, factor, isotropic), out + 0 * kPanel);
  add(d, mask, hn::Mul(xy, factor), out + 1 * kPanel);
  add(d, mask, hn::Mul(xz, factor), out + 2 * kPanel);
  add(d, mask, hn::Mul(xy, factor), out + 3 * kPanel);
  add(d, mask, hn::MulAdd(yy, factor, isotropic), out + 4 * kPanel);
  add(d, mask, hn::Mul(yz, factor), out + 5 * kPanel);
  add(d, mask, hn::Mul(xz, factor), out + 6 * kPanel);
  add(d, mask, hn::Mul(yz, factor), out + 7 * kPanel);
  add(d, mask, hn::MulAdd(zz, factor, isotropic), out + 8 * kPanel);
}

/// Calls f(first, lanes) for each vector of the panel that has a point in the mask; bit 0 of lanes is point `first`.
template <class F>
HWY_INLINE void for_each_vector(PanelMask mask, F f) {
  const std::size_t step = hn::Lanes(D());
  for (std::size_t first = 0; first < kPanel; first += step) {
    const PanelMask lanes = (mask >> first) & ((1u << step) - 1u);
    if (lanes != 0) f(first, lanes);
  }
}

void double_layer_of_panel(const Kelvin<double>& kernel, const PointPanel& panel, PanelMask mask,
                           const SourcePoints& source, const double* normal, double* const* out) {
  for_each_vector(mask, [&](std::size_t first, PanelMask lanes)
                            HWY_ATTR { double_layer_of_vector(kernel, panel, first, lanes, source, normal, out); });
}

void single_layer_of_panel(const Kelvin<double>& kernel, const PointPanel& panel, PanelMask mask,
                           const SourcePoints& source, double* out) {
  for_each_vector(mask, [&](std::size_t first, PanelMask lanes)
                            HWY_ATTR { single_layer_of_vector(kernel, panel, first, lanes, source, out); });
}

}  // namespace HWY_NAMESPACE
}  // namespace skinbem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skinbem {

HWY_EXPORT(double_layer_of_panel);
HWY_EXPORT(single_layer_of_panel);

void add_double_layer(const Kelvin<double>& kernel, const PointPanel& panel, PanelMask mask, const SourcePoints& source,
                      const Eigen::Vector3d& n, double* const out[3]) {
  HWY_DYNAMIC_DISPATCH(double_layer_of_panel)(kernel, panel, mask, source, n.data(), out);
}

void add_single_layer(const Kelvin<double>& kernel, const PointPanel& panel, PanelMask mask, const SourcePoints& source,
                      double* out) {
  HWY_DYNAMIC_DISPATCH(single_layer_of_panel)(kernel, panel, mask, source, out);
}

const char* instruction_set() {
  const std::int64_t supported = hwy::SupportedTargets() & HWY_TARGETS;
  return hwy::TargetName(supported & -supported);
}

}  // namespace skinbem
#endif
