// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Where the entries of a panel of rows are summed.
#pragma once

#include <cstdint>
#include <span>

#include <skinbem/base/aligned_buffer.hpp>
#include <skinbem/kernels/panel.hpp>

namespace skinbem::detail {

/// The entries of one panel of rows in the columns asked for, in slots: one a column, and one more that takes what is
/// not asked for.
template <class Kernel, class Real>
class ColumnBlock {
 public:
  static constexpr int components = Kernel::components;
  static constexpr std::size_t entries = components * components;

  /// All entries zero. `slot_of` is by vertex, -1 for those that are not asked for; it is not copied.
  void prepare(std::span<const std::int32_t> slot_of, std::size_t slots) {
    slot_of_ = slot_of;
    slots_ = slots;
    values_.assign((slots + 1) * entries * kPanel, Real(0));
  }
  /// Entry e of point p is in [e kPanel + p], aligned to 64 bytes.
  Real* slot(std::size_t k) { return values_.data() + k * entries * kPanel; }
  Real* slot_at(std::int32_t vertex) {
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
  AlignedVector<Real> values_;  ///< [slot][entry][point]
};

}  // namespace skinbem::detail
