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

/// Where slivers meet, a vertex's block with itself is close to singular, and multiplies what quadrature and
/// refinement leave of its equations.
TEST(ResponseOfANeedle, MeetsItsToleranceAtTheTip) {
  for (const double length : {6, 12, 40, 300}) {
    const TriangleMesh mesh = spiked_sphere(3, length);
    const auto response = [&](double requested) {
      ResponseModel made(mesh, {.poisson = 0.45, .tolerance = requested, .solver = Solver::dense});
      made.add(landmarks_on({vertex_at(mesh, {-1, 0, 0}), vertex_at(mesh, {0, -1, 0}), vertex_at(mesh, {0, 0, -1})}));
      return made.response();
    };
    const Eigen::MatrixXd expected = response(1e-10);
    for (const double requested : {1e-2, 1e-3, 1e-4, 1e-6}) {
      const double error = (response(requested) - expected).cwiseAbs().maxCoeff() / expected.cwiseAbs().maxCoeff();
      EXPECT_LE(error, requested) << length;
    }
  }
}

}  // namespace
}  // namespace skinbem
