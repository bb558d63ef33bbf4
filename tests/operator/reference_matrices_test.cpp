// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <tuple>

#include <skinbem/operator/collocation.hpp>

#include "files.hpp"
#include "reference_data.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using testing_support::read_reference_npy;
using testing_support::read_reference_obj;
using testing_support::shared_data;

class ReferenceMatrices : public ::testing::TestWithParam<double> {
 protected:
  std::filesystem::path file(const std::string& matrix) const {
    return shared_data("reference/icosphere42_" + matrix + (GetParam() == 0.3 ? "_nu030.npy" : "_nu045.npy"));
  }
};

TEST_P(ReferenceMatrices, DoubleLayerEqualsTheReference) {
  SKINBEM_NEEDS_SHARED_DATA("reference/icosphere42.obj");
  const Collocation<Kelvin<double>> collocation(read_reference_obj(shared_data("reference/icosphere42.obj")),
                                                {GetParam(), 1.0}, {1e-13});
  const Eigen::MatrixXd H = collocation.double_layer_matrix();
  EXPECT_LE((H - read_reference_npy(file("H"))).cwiseAbs().maxCoeff(), tolerance::reference_matrix);
}

TEST_P(ReferenceMatrices, SingleLayerEqualsTheReference) {
  SKINBEM_NEEDS_SHARED_DATA("reference/icosphere42.obj");
  const Collocation<Kelvin<double>> collocation(read_reference_obj(shared_data("reference/icosphere42.obj")),
                                                {GetParam(), 1.0}, {1e-13});
  const Eigen::MatrixXd G = read_reference_npy(file("G"));
  for (std::int32_t v = 0; v < 42; ++v) {
    const VertexWeight hat{v, 1.0};
    const Eigen::MatrixXd columns = collocation.single_layer_columns(std::span(&hat, 1));
    EXPECT_LE((columns - G.middleCols<3>(3 * v)).cwiseAbs().maxCoeff(), tolerance::reference_matrix) << v;
  }
}

TEST_P(ReferenceMatrices, CoarserToleranceIsMetByEveryBlock) {
  SKINBEM_NEEDS_SHARED_DATA("reference/icosphere42.obj");
  const Eigen::MatrixXd reference = read_reference_npy(file("H"));
  for (const double requested : {1e-3, 1e-5, 1e-7, 1e-9, 1e-11}) {
    const Collocation<Kelvin<double>> collocation(read_reference_obj(shared_data("reference/icosphere42.obj")),
                                                  {GetParam(), 1.0}, {requested});
    const Eigen::MatrixXd H = collocation.double_layer_matrix();
    // a block is the sum of some six element integrals, that may cancel in part
    EXPECT_LE((H - reference).cwiseAbs().maxCoeff(), requested * reference.cwiseAbs().maxCoeff()) << requested;
  }
}

/// The project's own meshes and matrices, integrated in quadruple precision (tests/reference/README.md).
class OwnReferenceMatrices : public ::testing::TestWithParam<std::tuple<const char*, const char*>> {
 protected:
  std::filesystem::path file(const std::string& end) const {
    return testing_support::project_file("tests/reference/" + std::string(std::get<0>(GetParam())) + end);
  }
  std::filesystem::path matrix(const std::string& name) const {
    return file("_" + name + "_nu" + std::get<1>(GetParam()) + ".npy");
  }
  Collocation<Kelvin<double>> collocation() const {
    const double poisson = std::stod(std::get<1>(GetParam())) / 100;
    return {read_reference_obj(file(".obj")), {poisson, 1.0}, {1e-13}};
  }
};

TEST_P(OwnReferenceMatrices, DoubleLayerEqualsTheReference) {
  const Eigen::MatrixXd H = collocation().double_layer_matrix();
  EXPECT_LE((H - read_reference_npy(matrix("H"))).cwiseAbs().maxCoeff(), tolerance::reference_matrix);
}

TEST_P(OwnReferenceMatrices, LandmarkColumnsOfTheSingleLayerEqualTheReference) {
  const auto vertices = testing_support::read_reference_column(file("_landmarks.csv"), "vertex");
  const Eigen::MatrixXd G = read_reference_npy(matrix("G"));
  ASSERT_EQ(G.cols(), 3 * Index(vertices.size()));
  for (std::size_t k = 0; k < vertices.size(); ++k) {
    const VertexWeight hat{std::stoi(vertices[k]), 1.0};
    const Eigen::MatrixXd columns = collocation().single_layer_columns(std::span(&hat, 1));
    EXPECT_LE((columns - G.middleCols<3>(3 * Index(k))).cwiseAbs().maxCoeff(),
              tolerance::reference_matrix * G.cwiseAbs().maxCoeff());
  }
}

INSTANTIATE_TEST_SUITE_P(Shipped, OwnReferenceMatrices,
                         ::testing::Combine(::testing::Values("box", "ellipsoid"), ::testing::Values("030", "045")));
INSTANTIATE_TEST_SUITE_P(Poisson, ReferenceMatrices, ::testing::Values(0.3, 0.45));

}  // namespace
}  // namespace skinbem
