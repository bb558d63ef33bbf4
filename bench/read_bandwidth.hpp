// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// How fast this machine reads: the measure of every frame.
#pragma once

#include <cstddef>

namespace skinbem::bench {

/// Read `floats` numbers (a multiple of 256, 64-byte aligned) with the widest vectors of the machine, in one stream or
/// at eight places in turns, which from memory may be faster. Return something that depends on all of them.
float read_stream(const float* data, std::size_t floats);
float read_in_turns(const float* data, std::size_t floats);

}  // namespace skinbem::bench
