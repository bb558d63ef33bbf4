// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The skin slides over the bone: L of equation (5), as random numbers that anyone can draw again.
#pragma once

#include <cstdint>

#include <skinbem/base/types.hpp>

namespace skinbem {

/// How L ~ N(mean, sigma^2) varies. In all kinds the landmarks are independent of one another.
enum class ArtefactKind {
  none,        ///< no artefact
  trial,       ///< one L per landmark for the whole trial
  correlated,  ///< L drifts smoothly and stationarily in time (see correlation_time)
  frame,       ///< a new L in every frame, as in the paper; it jitters
};

struct ArtefactOptions {
  ArtefactKind kind = ArtefactKind::none;
  std::uint64_t seed = 1;
  double mean = 5;     ///< unit of the mesh; the paper's 5 mm
  double sigma = 1.6;  ///< unit of the mesh, >= 0; the paper's 1.6 mm
  /// Seconds, > 0: the correlation of L(t) and L(t + d) is about exp(-(d / correlation_time)^2).
  double correlation_time = 0.25;

  /// Throws Error(usage) when a value is out of its range.
  void validate() const;
};

/// The number `index` of stream `stream` of independent standard normal deviates: SplitMix64 as a counter-based
/// generator, Box-Muller. The same on every machine whose libm rounds alike, in any order and on any number of threads.
double standard_normal(std::uint64_t seed, std::uint64_t stream, std::int64_t index);

/// L of landmark `landmark` in frame `frame`, which is at `time` seconds; 0 for `none`. `trial` and `correlated` do not
/// depend on the frame rate, so a resampled motion has the same artefact.
double artefact_length(const ArtefactOptions& options, Index landmark, Index frame, double time);

}  // namespace skinbem
