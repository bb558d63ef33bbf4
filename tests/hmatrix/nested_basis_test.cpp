// SPDX-License-Identifier: BSD-3-Clause
// Interpolative decomposition, and the bases made by it.
#include <gtest/gtest.h>

#include <Eigen/QR>
#include <set>
#include <skinbem/hmatrix/nested_basis.hpp>
#include <skinbem/hmatrix/tile_product.hpp>
#include <skinbem/mesh/mesh_io.hpp>

#include "files.hpp"
#include "meshes.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using namespace testing_support;

Eigen::MatrixXd orthonormal(Index rows, Index columns) {
  const Eigen::MatrixXd random = Eigen::MatrixXd::Random(rows, columns);
  return Eigen::HouseholderQR<Eigen::MatrixXd>(random).householderQ() * Eigen::MatrixXd::Identity(rows, columns);
}

/// Singular values 1, ratio, ratio^2, ... `rank` of them.
Eigen::MatrixXd matrix_with_decay(Index rows, Index columns, Index rank, double ratio) {
  std::srand(1);
  const Eigen::VectorXd sigma = Eigen::VectorXd::NullaryExpr(rank, [&](Index k) { return std::pow(ratio, double(k)); });
  return orthonormal(rows, rank) * sigma.asDiagonal() * orthonormal(columns, rank).transpose();
}

Eigen::MatrixXd chosen_columns(const Eigen::MatrixXd& A, const ColumnSelection& selection) {
  Eigen::MatrixXd result(A.rows(), Index(selection.columns.size()));
  for (Index k = 0; k < result.cols(); ++k) result.col(k) = A.col(selection.columns[k]);
  return result;
}

TEST(ColumnSelection, ReproducesAMatrixOfLowRankFromThatManyColumns) {
  for (const Index rank : {1, 5, 16, 23}) {
    const Eigen::MatrixXd A = matrix_with_decay(90, 40, rank, 0.9);
    const ColumnSelection selection = select_columns(A.transpose() * A, 1e-6);
    EXPECT_EQ(Index(selection.columns.size()), rank);  // no multiple of kTileStep: there are no more
    EXPECT_EQ(std::set(selection.columns.begin(), selection.columns.end()).size(), selection.columns.size());
    EXPECT_LE((A - chosen_columns(A, selection) * selection.weights.transpose()).norm(),
              tolerance::normal_equations * A.norm());
  }
}

TEST(ColumnSelection, KeepsItsToleranceInTheFrobeniusNorm) {
  const Eigen::MatrixXd A = matrix_with_decay(200, 96, 96, 0.8);
  std::size_t before = 0;
  for (const double tolerance : {3e-1, 1e-1, 1e-2, 1e-3, 1e-5}) {
    const ColumnSelection selection = select_columns(A.transpose() * A, tolerance);
    const double error = (A - chosen_columns(A, selection) * selection.weights.transpose()).norm() / A.norm();
    EXPECT_LE(error, tolerance);
    EXPECT_GE(selection.columns.size(), before);
    EXPECT_EQ(selection.columns.size() % kTileStep, 0u);
    before = selection.columns.size();
  }
  EXPECT_LT(before, 96u);
}

TEST(ColumnSelection, KeepsTheChosenColumnsThemselves) {
  const Eigen::MatrixXd A = matrix_with_decay(100, 48, 48, 0.7);
  const ColumnSelection selection = select_columns(A.transpose() * A, 1e-3);
  for (std::size_t k = 0; k < selection.columns.size(); ++k) {
    const Eigen::RowVectorXd unit = Eigen::RowVectorXd::Unit(Index(selection.columns.size()), Index(k));
    EXPECT_LE((selection.weights.row(selection.columns[k]) - unit).cwiseAbs().maxCoeff(), tolerance::normal_equations);
  }
}

TEST(ColumnSelection, ExpressesFurtherColumnsByThoseItKept) {
  const Eigen::MatrixXd A = matrix_with_decay(120, 48, 48, 0.75);
  const Eigen::MatrixXd C = A * Eigen::MatrixXd::Random(48, 30);
  Eigen::MatrixXd gram(78, 48);
  gram << A.transpose() * A, C.transpose() * A;
  const double tolerance = 1e-3;
  const ColumnSelection selection = select_columns(gram, tolerance);
  ASSERT_EQ(selection.weights.rows(), 78);
  const Eigen::MatrixXd fitted = chosen_columns(A, selection) * selection.weights.bottomRows(30).transpose();
  EXPECT_LE((C - fitted).norm(), 10 * tolerance * C.norm());
  EXPECT_LE((chosen_columns(A, selection).transpose() * (C - fitted)).norm(),  // least squares
            tolerance::normal_equations * C.norm() * A.norm());
}

TEST(ColumnSelection, ReadsTheLowerHalfOfTheGramMatrixOnly) {
  const Eigen::MatrixXd A = matrix_with_decay(60, 32, 32, 0.8);
  const Eigen::MatrixXd gram = A.transpose() * A;
  Eigen::MatrixXd lower = gram;
  lower.triangularView<Eigen::StrictlyUpper>().setConstant(std::nan(""));
  const ColumnSelection expected = select_columns(gram, 1e-2), found = select_columns(lower, 1e-2);
  EXPECT_EQ(found.columns, expected.columns);
  EXPECT_EQ(found.weights, expected.weights);
}

TEST(ColumnSelection, OfNothingKeepsNothing) {
  EXPECT_TRUE(select_columns(Eigen::MatrixXd::Zero(20, 20), 1e-3).columns.empty());
  EXPECT_TRUE(select_columns(Eigen::MatrixXd(5, 0), 1e-3).columns.empty());
}

/// The fields of a leaf's hat functions and of the dipoles that stand for them, weighted, at many more samples than
/// these were made from: what they miss, relative to the former.
class LeafColumns {
 public:
  LeafColumns(const TriangleMesh& mesh, const BasisOptions& options)
      : tree_(mesh),
        partition_(tree_, 1),
        collocation_(mesh, {0.45, 1.0}, {1e-6}),
        kernel_(mesh, tree_, collocation_.kernel()),
        sampler_(mesh, tree_, partition_),
        bases_(make_nested_bases(mesh, tree_, partition_, collocation_, kernel_, options, [](double) {})) {}

  const std::vector<std::int32_t>& leaves() const { return tree_.leaves(); }
  double missed(std::int32_t leaf) const {
    const FarSamples samples = sampler_.samples(leaf, 1000);
    if (samples.places.empty()) return 0;
    const Eigen::MatrixXd hats = of_hats(leaf, samples);
    return (hats - of_dipoles(leaf, samples) * bases_.columns[leaf].interpolation.transpose()).norm() / hats.norm();
  }

 private:
  static constexpr int components = 3;
  Index equation(std::size_t sample, int i) const { return tree_row(std::int32_t(sample), i, components); }

  Eigen::MatrixXd of_hats(std::int32_t leaf, const FarSamples& samples) const {
    const Cluster& cluster = tree_.clusters()[leaf];
    std::vector<std::int32_t> rows;
    for (const std::int32_t place : samples.places) rows.push_back(tree_.order()[place]);
    const auto columns = std::span(tree_.order()).subspan(cluster.begin, cluster.size());
    Eigen::MatrixXd field =
        Eigen::MatrixXd::Zero(components * Index(rows.size()), bases_.columns[leaf].interpolation.rows());
    collocation_.for_double_layer_panels(rows, columns, [&](std::size_t first, std::size_t, const double* values) {
      for (std::size_t p = 0; p < kPanel; ++p) {
        for (std::int32_t v = 0; v < cluster.size(); ++v) {
          for (int i = 0; i < components; ++i) {
            for (int j = 0; j < components; ++j) {
              field(equation(first + p, i), tree_row(v, j, components)) =
                  samples.area_root[first + p] * values[(v * 9 + 3 * i + j) * kPanel + p];
            }
          }
        }
      }
    });
    return field;
  }
  Eigen::MatrixXd of_dipoles(std::int32_t leaf, const FarSamples& samples) const {
    const std::vector<Dof>& skeleton = bases_.columns[leaf].skeleton;
    Eigen::MatrixXd field(components * Index(samples.places.size()), Index(skeleton.size()));
    for (std::size_t k = 0; k < skeleton.size(); ++k) {
      const double* values = kernel_.values(samples.places, std::span(&skeleton[k].point, 1));
      for (std::size_t q = 0; q < samples.places.size(); ++q) {
        for (int i = 0; i < components; ++i) {
          field(equation(q, i), Index(k)) =
              samples.area_root[q] * values[(q / kPanel * 9 + 3 * i + skeleton[k].component) * kPanel + q % kPanel];
        }
      }
    }
    return field;
  }

  ClusterTree tree_;
  BlockPartition partition_;
  Collocation<Kelvin<double>> collocation_;
  PointKernel<Kelvin<double>> kernel_;
  FarSampler sampler_;
  NestedBases bases_;
};

struct Body {
  const char* name;
  TriangleMesh (*make)();
};
class NestedBasesOf : public ::testing::TestWithParam<Body> {};

TEST_P(NestedBasesOf, DipolesActAsTheHatFunctionsOfEveryLeafDo) {
  for (const double requested : {1e-3, 3e-5}) {
    const LeafColumns columns(GetParam().make(), {requested});
    for (const std::int32_t leaf : columns.leaves()) {
      EXPECT_LE(columns.missed(leaf), tolerance::missed_by_dipoles * requested) << requested;
    }
  }
}

INSTANTIATE_TEST_SUITE_P(
    Bodies, NestedBasesOf,
    ::testing::Values(Body{"cube", [] { return cube(12); }}, Body{"slab", [] { return thin_slab(20); }},
                      Body{"needle", [] { return needle_box(150); }},
                      Body{"leaf",
                           [] {
                             return ellipsoid(4, {1, 0.3, 0.03});
                           }},  // some vertices are far from others
                      Body{"leg", [] { return read_mesh(project_file("data/lower_limb/skin.obj")); }}),
    [](const auto& body) { return body.param.name; });

}  // namespace
}  // namespace skinbem
