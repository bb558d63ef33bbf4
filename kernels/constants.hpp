// SPDX-License-Identifier: BSD-3-Clause
#pragma once

#include <cmath>

namespace skinbem {

/// pi in the precision of T, for any T whose acos is found by argument-dependent lookup or in std.
template <class T>
T pi() {
  using std::acos;
  static const T value = acos(T(-1));
  return value;
}

}  // namespace skinbem
