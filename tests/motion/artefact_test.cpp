// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/motion/artefact.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include <skinbem/base/error.hpp>

#include "tolerances.hpp"

namespace skinbem {
namespace {

struct Moments {
  double mean, deviation;
};

Moments moments(int count, const std::function<double(int)>& draw) {
  double sum = 0, squares = 0;
  for (int i = 0; i < count; ++i) {
    sum += draw(i);
    squares += draw(i) * draw(i);
  }
  const double mean = sum / count;
  return {mean, std::sqrt(squares / count - mean * mean)};
}

ArtefactOptions options(ArtefactKind kind, std::uint64_t seed = 7) {
  ArtefactOptions result;
  result.kind = kind;
  result.seed = seed;
  return result;
}

TEST(Artefact, TheGeneratorDrawsTheSameBitsForTheSameSeed) {
  EXPECT_EQ(standard_normal(1, 2, 3), standard_normal(1, 2, 3));
  EXPECT_NE(standard_normal(1, 2, 3), standard_normal(2, 2, 3));
  EXPECT_NE(standard_normal(1, 2, 3), standard_normal(1, 3, 3));
  EXPECT_NE(standard_normal(1, 2, 3), standard_normal(1, 2, -3));
}

TEST(Artefact, HasTheMeanAndDeviationThatWereAsked) {
  const int count = 20000;
  for (const ArtefactKind kind : {ArtefactKind::trial, ArtefactKind::frame, ArtefactKind::correlated}) {
    // Over landmarks at one moment, and over moments (10 s apart, so independent) where it varies.
    const Moments over_landmarks = moments(count, [&](int k) { return artefact_length(options(kind), k, 5, 0.123); });
    EXPECT_NEAR(over_landmarks.mean, 5, 1.6 * tolerance::sampling);
    EXPECT_NEAR(over_landmarks.deviation, 1.6, 1.6 * tolerance::sampling);
    if (kind == ArtefactKind::trial) continue;
    const Moments over_time = moments(count, [&](int f) { return artefact_length(options(kind), 0, f, 10.0 * f); });
    EXPECT_NEAR(over_time.mean, 5, 1.6 * tolerance::sampling);
    EXPECT_NEAR(over_time.deviation, 1.6, 1.6 * tolerance::sampling);
  }
}

TEST(Artefact, OfATrialIsConstantAndOfAFrameIsNot) {
  const auto length = [](ArtefactKind kind, Index frame) { return artefact_length(options(kind), 1, frame, 0.5); };
  EXPECT_EQ(length(ArtefactKind::trial, 0), length(ArtefactKind::trial, 90));
  EXPECT_NE(length(ArtefactKind::frame, 0), length(ArtefactKind::frame, 1));
  EXPECT_EQ(length(ArtefactKind::none, 0), 0);
}

TEST(Artefact, CorrelatedDriftsSmoothlyWithTheDocumentedCorrelation) {
  const ArtefactOptions drift = options(ArtefactKind::correlated);
  const double step = 1e-3;
  double steepest = 0;
  for (int i = 0; i < 2000; ++i) {
    const double now = artefact_length(drift, 0, 0, i * step), next = artefact_length(drift, 0, 0, (i + 1) * step);
    steepest = std::max(steepest, std::abs(next - now) / step);
  }
  // The slope's deviation is sqrt(2) sigma / correlation_time = 9 per second; no step over six of them.
  EXPECT_LE(steepest, 6 * std::sqrt(2) * drift.sigma / drift.correlation_time);

  const int count = 20000;
  for (const double lag : {0.1, 0.25, 0.5}) {
    double sum = 0;
    for (int k = 0; k < count; ++k) {
      sum += (artefact_length(drift, k, 0, 1.0) - drift.mean) * (artefact_length(drift, k, 0, 1.0 + lag) - drift.mean);
    }
    const double correlation = sum / count / (drift.sigma * drift.sigma);
    EXPECT_NEAR(correlation, std::exp(-std::pow(lag / drift.correlation_time, 2)), tolerance::sampling) << lag;
  }
}

TEST(Artefact, RefusesWhatIsOutOfRange) {
  ArtefactOptions wrong;
  wrong.sigma = -1;
  EXPECT_THROW(wrong.validate(), Error);
  wrong = {};
  wrong.mean = std::numeric_limits<double>::quiet_NaN();
  EXPECT_THROW(wrong.validate(), Error);
  wrong = {};
  wrong.correlation_time = 0;
  EXPECT_THROW(wrong.validate(), Error);
}

}  // namespace
}  // namespace skinbem
