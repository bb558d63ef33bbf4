// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// How fast this machine reads: the measure of every frame.
#pragma once

#include <cstddef>

namespace skinbem::bench {

/// Reads `floats` numbers (a multiple of 256, 64-byte aligned) in one stream with the widest vectors of the machine.
/// Returns something that depends on all of them.
float read_stream(const float* data, std::size_t floats);

}  // namespace skinbem::bench
