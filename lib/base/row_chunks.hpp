// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Work on long blocks of vectors by chunks of rows, in parallel. Memory that is written this way for the first time
/// gets its pages from all threads at once.
#pragma once

#include <algorithm>

#include <skinbem/base/types.hpp>

namespace skinbem::detail {

inline constexpr Index chunk_rows = 2048;

inline Index chunk_count(Index rows) { return (rows + chunk_rows - 1) / chunk_rows; }

/// body(first, count) for chunks of so many rows; where they begin does not depend on the number of threads.
template <class Body>
void for_each_chunk(Index rows, const Body& body) {
  const Index chunks = chunk_count(rows);
#pragma omp parallel for schedule(static) if (chunks > 1)
  for (Index k = 0; k < chunks; ++k) body(k * chunk_rows, std::min(chunk_rows, rows - k * chunk_rows));
}

}  // namespace skinbem::detail
