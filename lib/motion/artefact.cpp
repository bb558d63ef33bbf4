// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/motion/artefact.hpp>

#include <cmath>
#include <numbers>

#include <skinbem/base/error.hpp>

namespace skinbem {
namespace {

/// SplitMix64's output function (Steele, Lea and Flood 2014).
std::uint64_t mixed(std::uint64_t z) {
  z += 0x9e3779b97f4a7c15u;
  z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
  z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
  return z ^ (z >> 31);
}

/// In (0, 1], 53 bits.
double uniform(std::uint64_t bits) { return static_cast<double>((bits >> 11) + 1) * 0x1p-53; }

/// White noise on a grid of a quarter of the correlation time, smeared by a Gaussian and divided by the root of the
/// summed squares of its weights: variance 1 at every time.
double smooth_normal(const ArtefactOptions& options, std::uint64_t stream, double time) {
  // A window exp(-(t/w)^2) has the correlation exp(-(d/w)^2 / 2), hence w.
  const double width = options.correlation_time / std::numbers::sqrt2;
  const double step = options.correlation_time / 4;
  const double at = time / step;
  const auto nearest = static_cast<std::int64_t>(std::floor(at));
  constexpr std::int64_t reach = 17;  // steps: the weight has fallen below 1e-15 there
  double sum = 0, squares = 0;
  for (std::int64_t j = nearest - reach; j <= nearest + reach + 1; ++j) {
    const double distance = (at - static_cast<double>(j)) * step / width;
    const double weight = std::exp(-distance * distance);
    sum += weight * standard_normal(options.seed, stream, j);
    squares += weight * weight;
  }
  return sum / std::sqrt(squares);
}

}  // namespace

void ArtefactOptions::validate() const {
  if (!std::isfinite(mean)) throw Error(ErrorCode::usage, "the artefact's mean must be finite");
  if (!(sigma >= 0) || !std::isfinite(sigma))
    throw Error(ErrorCode::usage, "the artefact's sigma must not be negative");
  if (!(correlation_time > 0)) throw Error(ErrorCode::usage, "the artefact's correlation time must be positive");
}

double standard_normal(std::uint64_t seed, std::uint64_t stream, std::int64_t index) {
  const std::uint64_t key = mixed(mixed(mixed(seed) ^ stream) ^ static_cast<std::uint64_t>(index));
  const double radius = std::sqrt(-2 * std::log(uniform(mixed(key))));
  return radius * std::cos(2 * std::numbers::pi * uniform(mixed(key ^ 0xd1b54a32d192ed03u)));
}

double artefact_length(const ArtefactOptions& options, Index landmark, Index frame, double time) {
  const std::uint64_t stream = static_cast<std::uint64_t>(landmark);
  switch (options.kind) {
    case ArtefactKind::none:
      return 0;
    case ArtefactKind::trial:
      return options.mean + options.sigma * standard_normal(options.seed, stream, 0);
    case ArtefactKind::correlated:
      return options.mean + options.sigma * smooth_normal(options, stream, time);
    case ArtefactKind::frame:
      return options.mean + options.sigma * standard_normal(options.seed, stream, frame);
  }
  return 0;
}

}  // namespace skinbem
