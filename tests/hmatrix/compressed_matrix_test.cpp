// SPDX-License-Identifier: BSD-3-Clause
// The compressed double layer against the dense one.
#include <gtest/gtest.h>
#include <omp.h>

#include <algorithm>

#include <skinbem/hmatrix/compressed_matrix.hpp>
#include <skinbem/mesh/adjacency.hpp>
#include <skinbem/mesh/mesh_io.hpp>

#include "files.hpp"
#include "meshes.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using namespace testing_support;

constexpr double kPoisson = 0.45;

/// Random columns, then smooth ones: the coordinates' low trigonometric functions.
Eigen::MatrixXd vectors(const TriangleMesh& mesh) {
  std::srand(2);
  Eigen::MatrixXd V = Eigen::MatrixXd::Random(3 * mesh.vertex_count(), 12);
  const double size = diagonal(mesh);
  for (Index k = 0; k < mesh.vertex_count(); ++k) {
    const Vec3 x = mesh.vertices.row(k) / size;
    for (int c = 0; c < 2; ++c) {
      for (int d = 0; d < 3; ++d) V.block<3, 1>(3 * k, 6 + 3 * c + d) = Vec3::Unit(d) * std::sin(2 * x[d] + 3 * x[c]);
    }
  }
  return V;
}

template <class T>
Eigen::MatrixXd product(const CompressedMatrix<T>& H, const Eigen::MatrixXd& V) {
  VectorBlock Y;
  typename CompressedMatrix<T>::Block work;
  H.multiply(H.to_tree(V), Y, work);
  return H.from_tree(Y);
}

struct NamedMesh {
  const char* name;
  TriangleMesh (*make)();
};

TriangleMesh leg() { return read_mesh(project_file("data/lower_limb/skin.obj")); }

class Compressed : public ::testing::TestWithParam<NamedMesh> {
 protected:
  TriangleMesh mesh_ = GetParam().make();
  Collocation<Kelvin<double>> collocation_{mesh_, {kPoisson, 1.0}, {1e-8}};
  RowMajorMatrix dense_ = collocation_.double_layer_matrix();

  template <class T>
  CompressedMatrix<T> compressed(const CompressionOptions& options) const {
    return {mesh_, collocation_, options};
  }
  /// Largest |(H - dense) v| / |v|; H is about one half.
  template <class T>
  double error(const CompressionOptions& options) const {
    const Eigen::MatrixXd V = vectors(mesh_), difference = product(compressed<T>(options), V) - dense_ * V;
    return difference.colwise().norm().cwiseQuotient(V.colwise().norm()).maxCoeff();
  }
};

TEST_P(Compressed, SinglePrecisionAddsItsOwnRoundingOnly) {
  const double exactly = error<double>({1e-4, 1.5, 384});
  EXPECT_NEAR(error<float>({1e-4, 1.5, 384}), exactly, tolerance::compressed_f32);
}

TEST_P(Compressed, PackedNumbersAddTheirOwnRoundingOnly) {
  EXPECT_NEAR(error<float>({1e-4, 1.5, 384, true}), error<float>({1e-4, 1.5, 384}), tolerance::compressed_packed);
}

/// What rounding loses of one column its neighbour has: a field that is smooth sees less of it than a random one.
TEST_P(Compressed, RoundingErrorsOfNeighboursCancel) {
  const CompressionOptions dense{1e-3, 0, 192}, packed{1e-3, 0, 192, true};
  const Eigen::MatrixXd V = vectors(mesh_),
                        lost = product(compressed<float>(packed), V) - product(compressed<float>(dense), V);
  const Eigen::RowVectorXd sizes = lost.colwise().norm().cwiseQuotient(V.colwise().norm());
  EXPECT_LE(sizes.tail(6).mean(), 0.6 * sizes.head(6).mean());
}

TEST_P(Compressed, WithoutFarFieldItIsTheDenseMatrix) {
  EXPECT_EQ(compressed<float>({1e-3, 0, 192}).summary().mean_rank, 0);
  EXPECT_LE(error<double>({1e-3, 0, 192}), tolerance::invariance);
}

TEST_P(Compressed, AnnihilatesTranslations) {
  Eigen::MatrixXd ones(3 * mesh_.vertex_count(), 3);
  for (Index k = 0; k < mesh_.vertex_count(); ++k) ones.middleRows<3>(3 * k).setIdentity();
  EXPECT_LE(product(compressed<double>({1e-3}), ones).cwiseAbs().maxCoeff(), tolerance::rounding_of_sums);
  for (const bool packed : {false, true}) {
    const CompressedMatrix<float> H = compressed<float>({1e-3, 1.5, 192, packed});
    EXPECT_LE(product(H, ones).cwiseAbs().maxCoeff(), tolerance::compressed_f32);
  }
}

TEST_P(Compressed, SameBitsForOneAndTwoThreads) {
  const Eigen::MatrixXd V = vectors(mesh_);
  const int threads = omp_get_max_threads();
  omp_set_num_threads(1);
  const Eigen::MatrixXd one = product(compressed<float>({1e-3}), V);
  omp_set_num_threads(2);
  const Eigen::MatrixXd two = product(compressed<float>({1e-3}), V);
  omp_set_num_threads(threads);
  EXPECT_TRUE((one.array() == two.array()).all());
}

TEST_P(Compressed, NearEntriesAreTheDenseMatrixs) {
  const CompressedMatrix<float> H = compressed<float>({1e-3});
  const auto& clusters = H.tree().clusters();
  for (const std::int32_t leaf : {H.tree().leaves().front(), H.tree().leaves().back()}) {
    std::vector<std::int32_t> places;
    for (const std::int32_t neighbour : H.partition().near[leaf]) {
      for (std::int32_t k = clusters[neighbour].begin; k < clusters[neighbour].end; k += 3) places.push_back(k);
    }
    const Eigen::MatrixXf entries = H.near_entries(places);
    for (Index r = 0; r < Index(places.size()); ++r) {
      for (Index c = 0; c < Index(places.size()); ++c) {
        const Eigen::Matrix3d found = entries.block<3, 3>(3 * r, 3 * c).cast<double>();
        const Eigen::Matrix3d expected =
            dense_.block<3, 3>(3 * H.tree().order()[places[r]], 3 * H.tree().order()[places[c]]);
        // diagonal blocks carry the error of their row
        const double allowed = r == c ? 1e-3 : tolerance::compressed_f32;
        if (found.isZero(0)) continue;  // no neighbours
        ASSERT_LE((found - expected).cwiseAbs().maxCoeff(), allowed) << r << ' ' << c;
      }
    }
  }
}

/// For vectors that are zero but around one place, which leaves most blocks out.
TEST(CompressedMatrix, SparseProductIsTheSame) {
  const TriangleMesh mesh = leg();
  const Collocation<Kelvin<double>> collocation(mesh, {kPoisson, 1.0}, {1e-4});
  CompressionOptions options;
  options.packed = true;
  const CompressedMatrix<float> H(mesh, collocation, options);
  Eigen::MatrixXd V = Eigen::MatrixXd::Zero(3 * mesh.vertex_count(), 6);
  for (const std::int32_t v : {0, 100, 101, 102}) V.middleRows<3>(3 * v).setRandom();
  VectorBlock Y;
  CompressedMatrix<float>::Block work;
  H.multiply_sparse(H.to_tree(V), Y, work);
  const Eigen::MatrixXd expected = product(H, V);
  EXPECT_LE((H.from_tree(Y) - expected).norm(), tolerance::compressed_f32 * expected.norm());
  H.multiply_sparse(H.to_tree(Eigen::MatrixXd::Zero(V.rows(), 6)), Y, work);
  EXPECT_EQ(Y.norm(), 0);
}

TEST(CompressedMatrix, KeepsTheRowsOfANeedlesTip) {
  const TriangleMesh mesh = spiked_sphere(4, 6);
  const Collocation<Kelvin<double>> collocation(mesh, {kPoisson, 1.0}, {1e-6});
  const CompressedMatrix<float> H(mesh, collocation, {1e-2, 1.5, 192, true});
  const Index around = Index(neighbours_of_vertices(mesh)[0].size());
  EXPECT_EQ(H.summary().exact_vertices, 1 + around);
  const Eigen::MatrixXd V = vectors(mesh), found = product(H, V), exact = ExactRows(collocation, {0}).multiply(V);
  EXPECT_LE((found.topRows<3>() - exact).cwiseAbs().maxCoeff(), tolerance::invariance);
  const std::size_t place = std::find(H.tree().order().begin(), H.tree().order().end(), 0) - H.tree().order().begin();
  const Eigen::MatrixXf entries = H.near_entries({std::int32_t(place)});
  EXPECT_EQ(entries, H.diagonal()[place].cast<float>());
}

TEST_P(Compressed, TreesOrderIsAPermutation) {
  const CompressedMatrix<float> H = compressed<float>({1e-2});
  const Eigen::MatrixXd V = vectors(mesh_);
  const VectorBlock ordered = H.to_tree(V);
  EXPECT_EQ(ordered.rows(), H.rows());
  EXPECT_EQ(H.rows() % Index(3 * kPanel), 0);
  EXPECT_EQ(H.from_tree(ordered), V);
  EXPECT_NEAR(ordered.norm(), V.norm(), tolerance::rounding * V.norm());  // what fills up is zero
}

INSTANTIATE_TEST_SUITE_P(Bodies, Compressed,
                         ::testing::Values(NamedMesh{"cube", [] { return cube(9); }}, NamedMesh{"leg", leg},
                                           NamedMesh{"two_leaves",
                                                     [] {
                                                       return box({1, 1, 1}, {2, 4, 4});
                                                     }},
                                           NamedMesh{"tetrahedron", tetrahedron}),
                         [](const auto& body) { return body.param.name; });

class CompressionError : public Compressed {};

TEST_P(CompressionError, FallsWithTheTolerance) {
  for (const auto& [requested, samples] : {std::pair{1e-2, 192}, {1e-4, 384}, {1e-6, 640}}) {
    EXPECT_LE(error<double>({requested, 1.5, samples}), std::max(requested, tolerance::compression)) << requested;
  }
}

INSTANTIATE_TEST_SUITE_P(Bodies, CompressionError,
                         ::testing::Values(NamedMesh{"sphere", [] { return icosphere(3); }},
                                           NamedMesh{"cube", [] { return cube(12); }},
                                           NamedMesh{"slab", [] { return thin_slab(20); }}, NamedMesh{"leg", leg},
                                           NamedMesh{"needle", [] { return needle_box(150); }},
                                           NamedMesh{"hollow", [] { return hollow_sphere(3); }},
                                           NamedMesh{"torus", [] { return torus(1, 0.4, 32, 16); }}),
                         [](const auto& body) { return body.param.name; });

class CompressedAtPoisson : public ::testing::TestWithParam<double> {};

TEST_P(CompressedAtPoisson, KeepsItsErrorOnFlatFaces) {
  const TriangleMesh mesh = cube(10);
  const Collocation<Kelvin<double>> collocation(mesh, {GetParam(), 1.0}, {1e-6});
  const Eigen::MatrixXd V = vectors(mesh), exact = collocation.double_layer_matrix() * V;
  const Eigen::MatrixXd found = product(CompressedMatrix<double>(mesh, collocation, {1e-4, 1.5, 384}), V);
  EXPECT_LE((found - exact).colwise().norm().cwiseQuotient(exact.colwise().norm()).maxCoeff(), 1e-4);
}

INSTANTIATE_TEST_SUITE_P(Poisson, CompressedAtPoisson, ::testing::Values(-0.9, -0.5, 0.0, 0.3, 0.49, 0.5));

TEST(CompressedMatrix, DoesNotDependOnTheUnitOfLength) {
  const TriangleMesh mesh = slender_ellipsoid(3);
  const Eigen::MatrixXd V = vectors(mesh);
  Eigen::MatrixXd unit;
  for (const double scale : {1.0, 0x1p-20, 0x1p+20}) {
    const TriangleMesh scaled = stretched(mesh, Vec3::Constant(scale));
    const Collocation<Kelvin<double>> collocation(scaled, {kPoisson, 1.0}, {1e-6});
    const Eigen::MatrixXd found = product(CompressedMatrix<double>(scaled, collocation, {1e-3}), V);
    if (scale == 1) unit = found;
    EXPECT_EQ((found - unit).cwiseAbs().maxCoeff(), 0) << scale;
  }
}

TEST(CompressedMatrix, TakesAboutWhatWasPredicted) {
  for (const TriangleMesh& mesh : {leg(), slender_ellipsoid(4), cube(14)}) {
    const Collocation<Kelvin<double>> collocation(mesh, {kPoisson, 1.0}, {1e-4});
    for (const auto& [requested, packed] : {std::pair{1e-2, false}, {1e-4, false}, {1e-4, true}}) {
      const CompressionOptions options{requested, 1.5, 192, packed};
      const double real = double(CompressedMatrix<float>(mesh, collocation, options).bytes());
      const double predicted = double(predict_compressed_bytes(mesh, options, sizeof(float)));
      EXPECT_LE(predicted, real * tolerance::predicted_bytes) << mesh.vertex_count() << ' ' << requested;
      EXPECT_GE(predicted, real / tolerance::predicted_bytes) << mesh.vertex_count() << ' ' << requested;
    }
  }
}

TEST(CompressedMatrix, SizesInItsSummaryAreAllOfIt) {
  const TriangleMesh mesh = slender_ellipsoid(4);
  const Collocation<Kelvin<double>> collocation(mesh, {kPoisson, 1.0}, {1e-4});
  const CompressedMatrix<float> H(mesh, collocation, {1e-3}), packed(mesh, collocation, {1e-3, 1.5, 192, true});
  for (const auto* matrix : {&H, &packed}) {
    const CompressionSummary& s = matrix->summary();
    EXPECT_EQ(s.near_bytes + s.coupling_bytes + s.basis_bytes, matrix->bytes());
    EXPECT_GT(s.coupling_bytes, 0u);
  }
  EXPECT_LT(H.bytes(), 4 * 9 * std::size_t(mesh.vertex_count() * mesh.vertex_count()) / 2);
  EXPECT_LT(10 * packed.bytes(), 6 * H.bytes());
}

}  // namespace
}  // namespace skinbem
