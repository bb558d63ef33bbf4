// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <mutex>
#include <skinbem/quadrature/gauss_legendre.hpp>
#include <string>

namespace skinbem {

GaussView gauss_legendre(int n) {
  struct Slot {
    std::once_flag once;
    GaussRule<double> rule;
  };
  static std::array<Slot, max_cached_gauss_order> slots;
  if (n < 1 || n > max_cached_gauss_order)
    throw std::invalid_argument("Gauss-Legendre: cached rules have 1 to " + std::to_string(max_cached_gauss_order) +
                                " points, asked for " + std::to_string(n));
  Slot& slot = slots[n - 1];
  std::call_once(slot.once, [&] { slot.rule = make_gauss_legendre<double>(n); });
  return {slot.rule.nodes, slot.rule.weights};
}

}  // namespace skinbem
