// SPDX-License-Identifier: BSD-3-Clause
#include "read_bandwidth.hpp"

#undef HWY_TARGET_INCLUDE
#define HWY_TARGET_INCLUDE "read_bandwidth.cpp"
#include <hwy/foreach_target.h>
// foreach_target.h comes first
#include <hwy/cache_control.h>
#include <hwy/highway.h>

HWY_BEFORE_NAMESPACE();
namespace skinbem::bench {
namespace HWY_NAMESPACE {
namespace hn = hwy::HWY_NAMESPACE;

/// Reads `part` numbers of each of kPlaces places, one after the other in memory.
template <std::size_t kPlaces>
HWY_INLINE float read(const float* data, std::size_t part) {
  constexpr std::size_t kAhead = 256, kLine = 16;
  // Eight sums, or the latency of the addition would be what is measured.
  const hn::ScalableTag<float> d;
  const std::size_t lanes = hn::Lanes(d);
  auto s0 = hn::Zero(d), s1 = s0, s2 = s0, s3 = s0, s4 = s0, s5 = s0, s6 = s0, s7 = s0;
  for (std::size_t i = 0; i < part; i += 8 * lanes) {
    for (std::size_t place = 0; place < kPlaces; ++place) {
      const float* from = data + place * part + i;
      if constexpr (kPlaces > 1) {
        for (std::size_t j = 0; j < 8 * lanes; j += kLine) hwy::Prefetch(from + kAhead + j);
      }
      s0 = hn::Add(s0, hn::Load(d, from));
      s1 = hn::Add(s1, hn::Load(d, from + lanes));
      s2 = hn::Add(s2, hn::Load(d, from + 2 * lanes));
      s3 = hn::Add(s3, hn::Load(d, from + 3 * lanes));
      s4 = hn::Add(s4, hn::Load(d, from + 4 * lanes));
      s5 = hn::Add(s5, hn::Load(d, from + 5 * lanes));
      s6 = hn::Add(s6, hn::Load(d, from + 6 * lanes));
      s7 = hn::Add(s7, hn::Load(d, from + 7 * lanes));
    }
  }
  const auto low = hn::Add(hn::Add(s0, s1), hn::Add(s2, s3));
  const auto high = hn::Add(hn::Add(s4, s5), hn::Add(s6, s7));
  return hn::GetLane(hn::SumOfLanes(d, hn::Add(low, high)));
}

float read_stream(const float* data, std::size_t floats) { return read<1>(data, floats); }

float read_in_turns(const float* data, std::size_t floats) {
  constexpr std::size_t kPlaces = 8;
  const std::size_t part = floats / kPlaces / 256 * 256;
  return read<kPlaces>(data, part) + read<1>(data + kPlaces * part, floats - kPlaces * part);
}

}  // namespace HWY_NAMESPACE
}  // namespace skinbem::bench
HWY_AFTER_NAMESPACE();

#if HWY_ONCE
namespace skinbem::bench {

HWY_EXPORT(read_stream);
HWY_EXPORT(read_in_turns);

float read_stream(const float* data, std::size_t floats) { return HWY_DYNAMIC_DISPATCH(read_stream)(data, floats); }
float read_in_turns(const float* data, std::size_t floats) { return HWY_DYNAMIC_DISPATCH(read_in_turns)(data, floats); }

}  // namespace skinbem::bench
#endif
