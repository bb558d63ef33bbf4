// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/kernels/panel_reach.hpp>

#include <limits>

// Vectors of unknown size cannot be array elements; those targets use NEON or scalar code instead.
#define HWY_DISABLED_TARGETS (HWY_SVE | HWY_SVE2 | HWY_SVE_256 | HWY_SVE2_128 | HWY_RVV)
#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "skinbem/kernels/panel_reach.cpp"
// clang-format off
#include <hwy/foreach_target.h>
#include <hwy/highway.h>
// clang-format on

HWY_BEFORE_NAMESPACE();
namespace skinbem {
namespace HWY_NAMESPACE {

namespace hn = hwy::HWY_NAMESPACE;

PanelReach reach_of_panel(const PointPanel& panel, const double* centre, double limit2) {
  const hn::CappedTag<double, kPanel / 2> d;
  const auto x = hn::Set(d, centre[0]), y = hn::Set(d, centre[1]), z = hn::Set(d, centre[2]);
  const auto limit = hn::Set(d, limit2), infinity = hn::Set(d, std::numeric_limits<double>::infinity());
  hn::Vec<decltype(d)> closest2[] = {infinity, infinity};
  PanelReach reach{0, {}};
  for (std::size_t p = 0; p < kPanel; p += hn::Lanes(d)) {
    const auto dx = hn::Sub(hn::Load(d, panel.x + p), x);
    const auto dy = hn::Sub(hn::Load(d, panel.y + p), y);
    const auto dz = hn::Sub(hn::Load(d, panel.z + p), z);
    auto distance2 = hn::MulAdd(dz, dz, hn::MulAdd(dy, dy, hn::Mul(dx, dx)));
    const auto near = hn::Lt(distance2, limit);
    if (HWY_UNLIKELY(!hn::AllFalse(d, near))) {
      std::uint8_t bits[8] = {};
      hn::StoreMaskBits(d, near, bits);
      reach.near |= PanelMask(bits[0]) << p;
      distance2 = hn::IfThenElse(near, infinity, distance2);
    }
    auto& closest = closest2[p / (kPanel / 2)];
    closest = hn::Min(closest, distance2);
  }
  for (std::size_t half = 0; half < 2; ++half) reach.closest2[half] = hn::GetLane(hn::MinOfLanes(d, closest2[half]));
  return reach;
}

}  // namespace HWY_NAMESPACE
}  // namespace skinbem
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skinbem {

HWY_EXPORT(reach_of_panel);

PanelReach panel_reach(const PointPanel& panel, const Eigen::Vector3d& centre, double limit2) {
  return HWY_DYNAMIC_DISPATCH(reach_of_panel)(panel, centre.data(), limit2);
}

}  // namespace skinbem
#endif
