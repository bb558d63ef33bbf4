// SPDX-License-Identifier: BSD-3-Clause
// Couplings, computed in the product, against values of the kernel one by one.
#include <gtest/gtest.h>

#include <skinbem/hmatrix/couplings.hpp>

#include "meshes.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using namespace testing_support;

/// Skeletons of a body, and their coefficients in a workspace: those of columns first.
template <class T>
struct CouplingsOfABody : ::testing::Test {
  using Block = typename BlockRows<T>::Block;
  static constexpr Index columns = 7;

  TriangleMesh mesh = ellipsoid(4, {1, 0.4, 0.3});
  Kelvin<double> kelvin{0.4, 1.0};
  Collocation<Kelvin<double>> collocation{mesh, kelvin, {1e-6}};
  ClusterTree tree{mesh};
  BlockPartition partition{tree, 1};
  PointKernel<Kelvin<double>> kernel{mesh, tree, kelvin};
  NestedBases bases = make_nested_bases(mesh, tree, partition, collocation, kernel, {1e-4}, [](double) {});
  Index end = 0;
  std::vector<WorkRange> column_ranges = reserve(bases.columns), row_ranges = reserve(bases.rows);
  Couplings<T> couplings{kernel, bases, partition, row_ranges, column_ranges};

  std::vector<WorkRange> reserve(const std::vector<ClusterBasis>& of) {
    std::vector<WorkRange> ranges;
    for (const ClusterBasis& basis : of) {
      ranges.push_back({end, Index(basis.skeleton.size())});
      end += round_up(ranges.back().length, kTileStep);
    }
    return ranges;
  }
  Block random_workspace() const {
    std::srand(3);
    return Block::Random(end, columns);
  }
  /// Of one cluster, from the partners for which wanted(partner).
  template <class Wanted>
  Eigen::MatrixXd expected(std::size_t cluster, const Block& work, const Wanted& wanted) const {
    const std::vector<Dof>& rows = bases.rows[cluster].skeleton;
    Eigen::MatrixXd sum = Eigen::MatrixXd::Zero(Index(rows.size()), columns);
    for (const std::int32_t partner : partition.far[cluster]) {
      if (!wanted(partner)) continue;
      const std::vector<Dof>& dipoles = bases.columns[partner].skeleton;
      for (std::size_t r = 0; r < rows.size(); ++r) {
        for (std::size_t k = 0; k < dipoles.size(); ++k) {
          const Vec3 to = kernel.centroid(dipoles[k].point) - kernel.vertex(rows[r].point);
          const Mat3 value = kelvin.double_layer(to, kernel.normal(dipoles[k].point));
          sum.row(Index(r)) += value(rows[r].component, dipoles[k].component) *
                               work.row(column_ranges[partner].first + Index(k)).template cast<double>();
        }
      }
    }
    return sum;
  }
  template <class Wanted>
  void expect(const Block& before, const Block& after, const Wanted& wanted) const {
    for (std::size_t c = 0; c < partition.far.size(); ++c) {
      const Eigen::MatrixXd found = after.middleRows(row_ranges[c].first, row_ranges[c].length).template cast<double>();
      if (std::none_of(partition.far[c].begin(), partition.far[c].end(), wanted)) {
        EXPECT_EQ(found, before.middleRows(row_ranges[c].first, row_ranges[c].length).template cast<double>());
        continue;
      }
      const Eigen::MatrixXd sum = expected(c, before, wanted);
      const double allowed = sizeof(T) == 4 ? tolerance::compressed_f32 : tolerance::rounding_of_sums;
      EXPECT_LE((found - sum).norm(), allowed * sum.norm()) << c;
    }
  }
};

using Numbers = ::testing::Types<float, double>;
TYPED_TEST_SUITE(CouplingsOfABody, Numbers);

TYPED_TEST(CouplingsOfABody, AreValuesOfTheKernel) {
  const auto before = this->random_workspace();
  auto after = before;
  this->couplings.run(after);
  this->expect(before, after, [](std::int32_t) { return true; });
}

TYPED_TEST(CouplingsOfABody, LeaveOutWhatIsNotFilled) {
  FilledRanges filled(this->end);
  const auto is_wanted = [](std::int32_t cluster) { return cluster % 3 == 0; };
  for (std::size_t c = 0; c < this->column_ranges.size(); ++c) {
    if (this->column_ranges[c].length > 0 && is_wanted(std::int32_t(c))) filled.add(this->column_ranges[c]);
  }
  const auto before = this->random_workspace();
  auto after = before;
  this->couplings.run_sparse(after, filled);
  this->expect(before, after, is_wanted);
  for (std::size_t c = 0; c < this->row_ranges.size(); ++c) {
    if (this->row_ranges[c].length == 0) continue;
    const auto& far = this->partition.far[c];
    EXPECT_EQ(filled.contains(this->row_ranges[c]), std::any_of(far.begin(), far.end(), is_wanted));
  }
}

TYPED_TEST(CouplingsOfABody, CountTheirEntries) {
  std::size_t entries = 0;
  for (std::size_t c = 0; c < this->partition.far.size(); ++c) {
    for (const std::int32_t partner : this->partition.far[c]) {
      entries += this->bases.rows[c].skeleton.size() * this->bases.columns[partner].skeleton.size();
    }
  }
  EXPECT_GT(entries, 0u);
  EXPECT_GE(this->couplings.numbers(), entries);  // rows are filled up
  EXPECT_LE(this->couplings.numbers(), entries + entries / 4);
}

}  // namespace
}  // namespace skinbem
