// SPDX-License-Identifier: BSD-3-Clause
#include "read_bandwidth.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "read_bandwidth.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h comes first
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace skinbem::bench {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

float read_stream(const float* data, std::size_t floats) {
  // Eight sums, or the latency of the addition would be what is measured.
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  auto s0 = hn::Zero(d), s1 = s0, s2 = s0, s3 = s0, s4 = s0, s5 = s0, s6 = s0, s7 = s0;
  for (std::size_t i = 0; i < floats; i += 8 * lanes) {
    const float* from = data + i;
    s0 = hn::Add(s0, hn::Load(d, from));
    s1 = hn::Add(s1, hn::Load(d, from + lanes));
    s2 = hn::Add(s2, hn::Load(d, from + 2 * lanes));
    s3 = hn::Add(s3, hn::Load(d, from + 3 * lanes));
    s4 = hn::Add(s4, hn::Load(d, from + 4 * lanes));
    s5 = hn::Add(s5, hn::Load(d, from + 5 * lanes));
    s6 = hn::Add(s6, hn::Load(d, from + 6 * lanes));
    s7 = hn::Add(s7, hn::Load(d, from + 7 * lanes));
  }
  const auto low = hn::Add(hn::Add(s0, s1), hn::Add(s2, s3));
  const auto high = hn::Add(hn::Add(s4, s5), hn::Add(s6, s7));
  return hn::GetLane(hn::SumOfLanes(d, hn::Add(low, high)));
}

}  // namespace HWY_NAMESPACE
}  // namespace skinbem::bench
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skinbem::bench {

HWY_EXPORT(read_stream);

float read_stream(const float* data, std::size_t floats) { return HWY_DYNAMIC_DISPATCH(read_stream)(data, floats); }

}  // namespace skinbem::bench
#endif
