// SPDX-License-Identifier: BSD-3-Clause
#include <gtest/gtest.h>

#include <skinbem/response/response_model.hpp>

#include "files.hpp"
#include "reference_data.hpp"
#include "response/bodies.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using namespace testing_support;

class ReferenceResponse : public ::testing::TestWithParam<std::tuple<double, double>> {
 protected:
  double poisson() const { return std::get<0>(GetParam()); }
  double requested() const { return std::get<1>(GetParam()); }
  std::filesystem::path file(const std::string& matrix, const std::string& extension) const {
    return shared_data("reference/icosphere162_" + matrix + (poisson() == 0.3 ? "_nu030" : "_nu045") + extension);
  }
  ResponseModel model() const {
    std::vector<std::int32_t> vertices;
    for (const auto& v : read_reference_column(shared_data("reference/icosphere162_landmarks.csv"), "vertex")) {
      vertices.push_back(std::stoi(v));
    }
    ResponseModel made(read_reference_obj(shared_data("reference/icosphere162.obj")), {poisson(), requested(), {}});
    made.add(landmarks_on(vertices));
    return made;
  }
};

TEST_P(ReferenceResponse, IsMetToTheToleranceAskedFor) {
  SKINBEM_NEEDS_SHARED_DATA("reference/icosphere162.obj");
  const Eigen::MatrixXd expected = read_reference_npy(file("R", ".npy"));
  const Eigen::MatrixXd R = model().response();
  EXPECT_LE((R - expected).cwiseAbs().maxCoeff(), requested() * expected.cwiseAbs().maxCoeff());
}

TEST_P(ReferenceResponse, TractionsAreMetToo) {
  SKINBEM_NEEDS_SHARED_DATA("reference/icosphere162.obj");
  const Eigen::MatrixXd expected = read_reference_csv(file("T", ".csv"));
  const Eigen::MatrixXd T = model().tractions();
  EXPECT_LE((T - expected).cwiseAbs().maxCoeff(), requested() * expected.cwiseAbs().maxCoeff());
}

TEST_P(ReferenceResponse, ErrorIsNotAboveTheEstimate) {
  SKINBEM_NEEDS_SHARED_DATA("reference/icosphere162.obj");
  const Eigen::MatrixXd expected = read_reference_npy(file("R", ".npy"));
  const ResponseModel made = model();
  const double error = (made.response() - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
  EXPECT_LE(error, std::max(made.summary().estimated_error, tolerance::rounding_of_sums));
}

INSTANTIATE_TEST_SUITE_P(PoissonAndTolerance, ReferenceResponse,
                         ::testing::Combine(::testing::Values(0.3, 0.45), ::testing::Values(1e-3, 1e-6, 1e-10, 1e-12)));

}  // namespace
}  // namespace skinbem
