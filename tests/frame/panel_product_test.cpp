// SPDX-License-Identifier: BSD-3-Clause
// The kernel of a frame, on every instruction set that this machine has.
#include <gtest/gtest.h>
#include <hwy/targets.h>

#include <cmath>

#include <skinbem/frame/frame_factors.hpp>
#include <skinbem/frame/packing.hpp>

namespace skinbem {
namespace {

using namespace detail;

/// From now on; 0 for the best again.
void use_instruction_set(std::int64_t target) {
  hwy::SetSupportedTargetsForTest(target);
  hwy::GetChosenTarget().Update(hwy::SupportedTargets());
}

/// Those that this machine has and the kernel was compiled for.
std::vector<std::int64_t> instruction_sets() {
  std::vector<std::int64_t> sets;
  for (std::int64_t left = hwy::SupportedTargets(); left != 0; left &= left - 1) {
    const std::int64_t target = left & -left;
    use_instruction_set(target);
    if (std::string(instruction_set()) == hwy::TargetName(target)) sets.push_back(target);
    use_instruction_set(0);
  }
  return sets;
}

class EveryInstructionSet : public testing::TestWithParam<std::int64_t> {
 protected:
  void SetUp() override { use_instruction_set(GetParam()); }
  void TearDown() override { use_instruction_set(0); }
};
INSTANTIATE_TEST_SUITE_P(, EveryInstructionSet, testing::ValuesIn(instruction_sets()),
                         [](const auto& tested) { return std::string(hwy::TargetName(tested.param)); });

/// Entries of a panel for columns of numbers in [-size, size]; `kept` becomes what they stand for, a column of `kept`
/// for each column of the matrix.
std::vector<QuantisedEntry> random_entries(const std::vector<std::uint32_t>& columns, Eigen::MatrixXd& kept) {
  std::vector<QuantisedEntry> entries;
  for (const std::uint32_t column : columns) {
    const double size = std::pow(2.0, -double(column % 7));
    Eigen::VectorXd numbers = size * Eigen::VectorXd::Random(kColumnNumbers);
    const Eigen::VectorXd wanted = numbers;
    entries.push_back(quantise(column, numbers));
    kept.col(column) += wanted - numbers;
  }
  return entries;
}

std::vector<std::uint32_t> numbers_from(std::uint32_t first, std::uint32_t count) {
  std::vector<std::uint32_t> columns;
  for (std::uint32_t k = 0; k < count; ++k) columns.push_back(first + k);
  return columns;
}

std::vector<std::uint32_t> joined(std::vector<std::uint32_t> columns, const std::vector<std::uint32_t>& more) {
  columns.insert(columns.end(), more.begin(), more.end());
  return columns;
}

TEST_P(EveryInstructionSet, SumsQuantisedEntriesOfAnyColumns) {
  constexpr Index columns = 130, frames = 5;
  const std::vector<std::vector<std::uint32_t>> cases = {
      {},
      {0},
      {129},
      {7, 3},
      numbers_from(0, 18),
      numbers_from(113, 17),
      numbers_from(40, 33),
      joined(numbers_from(0, 18), {6, 7, 8}),
      joined(numbers_from(20, 64), {24, 25, 26, 50, 51, 52}),
      joined(numbers_from(0, 130), numbers_from(0, 40)),
  };
  const Points rest = 5 * Points::Random(2 * kPanelWidth - 3, 3);
  for (const auto& chosen : cases) {
    Eigen::MatrixXd kept[2] = {Eigen::MatrixXd::Zero(kColumnNumbers, columns),
                               Eigen::MatrixXd::Zero(kColumnNumbers, columns)};
    PackedPanels packed;
    packed.vertices = std::size_t(rest.rows());
    packed.quantised = true;
    for (std::size_t p = 0; p < 2; ++p) append_panel(rest, p, random_entries(chosen, kept[p]), packed);

    std::vector<AlignedVector<float>> weights(frames, make_weights(columns));
    std::vector<FrameFactors> factors(frames);
    std::vector<std::vector<float>> positions(frames, std::vector<float>(std::size_t(rest.size())));
    std::vector<FrameTarget> targets;
    for (Index f = 0; f < frames; ++f) {
      auto& w = weights[std::size_t(f)];
      for (Index k = 0; k < columns; ++k) w[std::size_t(k)] = 10 * float(std::sin(1.0 + double(k * (f + 2))));
      FrameFactors& frame = factors[std::size_t(f)];
      frame.weights = w.data();
      frame.weight_limit = weight_limit(w.data(), columns);
      repeat_rigid({}, Vec3::Zero(), frame);
      targets.push_back({positions[std::size_t(f)].data()});
    }
    const PanelMatrix matrix = packed.matrix();
    panel_product(matrix, 0, 2, factors.data(), targets.data(), frames);
    for (Index f = 0; f < frames; ++f) {
      const auto& w = weights[std::size_t(f)];
      const Eigen::VectorXd q = Eigen::Map<const Eigen::VectorXf>(w.data(), columns).cast<double>();
      // half a step of every weight, 2^-22 of the limit (16), times the panel's scale (2), and the rounding of float
      const double allowed = double(chosen.size()) * 32 * std::ldexp(0.5, -22) + 20 * std::ldexp(1.0, -23);
      for (Index v = 0; v < rest.rows(); ++v) {
        const Eigen::VectorXd sum = kept[v / Index(kPanelWidth)] * q;
        for (Index c = 0; c < 3; ++c) {
          const double expected = rest(v, c) + sum[c * Index(kPanelWidth) + v % Index(kPanelWidth)];
          EXPECT_NEAR(positions[std::size_t(f)][std::size_t(3 * v + c)], expected, allowed + 1e-6 * std::abs(expected))
              << chosen.size() << " entries, frame " << f << ", vertex " << v;
        }
      }
      std::vector<float> alone(std::size_t(rest.size()));
      const FrameTarget target{alone.data()};
      panel_product(matrix, 0, 2, &factors[std::size_t(f)], &target, 1);
      EXPECT_EQ(alone, positions[std::size_t(f)]) << "one frame and a batch are the same bits";
    }
  }
}

/// Positions of the panels [first, last) in one frame whose weights are q and whose motion is none.
std::vector<float> positions_of(PanelMatrix matrix, bool in_turns, std::size_t first, std::size_t last,
                                const AlignedVector<float>& q, Index columns) {
  FrameFactors frame;
  frame.weights = q.data();
  frame.weight_limit = weight_limit(q.data(), columns);
  repeat_rigid({}, Vec3::Zero(), frame);
  std::vector<float> positions(3 * matrix.vertices);
  const FrameTarget target{positions.data()};
  matrix.in_turns = in_turns;
  panel_product(matrix, first, last, &frame, &target, 1);
  return positions;
}

TEST_P(EveryInstructionSet, PanelsInTurnsAreTheSameBits) {
  constexpr std::size_t kPanels = 19;
  const Points rest = 5 * Points::Random(kPanels * kPanelWidth - 5, 3);
  const auto expect_same = [&](const PanelMatrix& matrix, Index columns) {
    AlignedVector<float> q = make_weights(columns);
    for (Index k = 0; k < columns; ++k) q[std::size_t(k)] = 10 * float(std::sin(1.0 + double(k)));
    for (const auto& [first, last] : {std::pair{0, 19}, {0, 16}, {3, 11}, {5, 8}, {18, 19}}) {
      const auto expected = positions_of(matrix, false, std::size_t(first), std::size_t(last), q, columns);
      EXPECT_EQ(positions_of(matrix, true, std::size_t(first), std::size_t(last), q, columns), expected)
          << columns << " columns, panels " << first << " to " << last;
    }
  };
  for (const Index columns : {0, 1, 2, 3, 18, 37}) {
    expect_same(pack_float32(rest, Eigen::MatrixXd::Random(rest.size(), columns)).matrix(), columns);
  }
  PackedPanels packed;
  packed.vertices = std::size_t(rest.rows());
  packed.quantised = true;
  Eigen::MatrixXd kept = Eigen::MatrixXd::Zero(kColumnNumbers, 130);
  for (std::uint32_t p = 0; p < kPanels; ++p) {  // panels of 0 to 130 entries, in no order
    append_panel(rest, p, random_entries(numbers_from(0, p * 73 % 131), kept), packed);
  }
  expect_same(packed.matrix(), 130);
}

TEST(WeightLimit, IsAPowerOfTwoAboveAllWeights) {
  const std::vector<float> weights = {0.5F, -4.0F, 3.0F};
  EXPECT_EQ(weight_limit(weights.data(), 3), 8.0F);
  EXPECT_EQ(weight_limit(weights.data(), 1), 1.0F);
  const float none = weight_limit(weights.data(), 0);
  EXPECT_GT(none, 0.0F);
  EXPECT_TRUE(std::isfinite(1 / none));
  const float largest = float(kLargestNumber);
  EXPECT_GT(weight_limit(&largest, 1), largest);
  EXPECT_TRUE(std::isfinite(weight_limit(&largest, 1)));
}

}  // namespace
}  // namespace skinbem
