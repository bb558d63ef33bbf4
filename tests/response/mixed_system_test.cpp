// SPDX-License-Identifier: BSD-3-Clause
// The answer by landmark Green's functions against the mixed system of Tang (2010), eq. (2), solved directly.
#include <gtest/gtest.h>

#include <Eigen/LU>
#include <skinbem/operator/collocation.hpp>
#include <skinbem/response/response_model.hpp>

#include "response/bodies.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using namespace testing_support;

struct Answer {
  Eigen::MatrixXd R;  ///< 3N by 3Nk
  Eigen::MatrixXd T;  ///< 3Nk by 3Nk
};

/// [H_U, -G_K][u_U; t_K] = -H_K u_K for unit displacements u_K.
Answer solve_mixed_system(const Body& body) {
  const Collocation<Kelvin<double>> collocation(body.mesh, {body.poisson, 1.0}, {1e-13});
  const Index n = 3 * body.mesh.vertex_count(), m = 3 * Index(body.landmarks.size());
  Eigen::MatrixXd system = collocation.double_layer_matrix();
  Eigen::MatrixXd right(n, m);
  for (Index k = 0; k < Index(body.landmarks.size()); ++k) {
    const VertexWeight hat{body.landmarks[k], 1.0};
    auto columns = system.middleCols<3>(3 * hat.vertex);
    right.middleCols<3>(3 * k) = -columns;
    columns = -collocation.single_layer_columns(std::span(&hat, 1));
  }
  Answer answer{Eigen::PartialPivLU<Eigen::MatrixXd>(system).solve(right), Eigen::MatrixXd(m, m)};
  for (Index k = 0; k < Index(body.landmarks.size()); ++k) {
    auto rows = answer.R.middleRows<3>(3 * body.landmarks[k]);
    answer.T.middleRows<3>(3 * k) = rows;
    rows.setZero();
    rows.middleCols<3>(3 * k).setIdentity();
  }
  return answer;
}

/// Largest difference relative to the largest entry.
double difference(const Eigen::MatrixXd& a, const Eigen::MatrixXd& b) {
  return (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff();
}

void expect_equal_to_mixed_system(const Body& body, double tolerance) {
  ResponseModel model(body.mesh, {body.poisson, 1e-12, {}});
  model.add(landmarks_on(body.landmarks));
  const Answer expected = solve_mixed_system(body);
  EXPECT_LE(difference(model.response(), expected.R), tolerance) << body.name;
  EXPECT_LE(difference(model.tractions(), expected.T), tolerance) << body.name;
}

TEST(MixedSystem, GivesTheSameResponseAndTractionsOnBodiesOfManyShapes) {
  for (const Body& body : bodies()) expect_equal_to_mixed_system(body, tolerance::mixed_system);
}

TEST(MixedSystem, GivesTheSameOnAThinSlab) {
  const TriangleMesh slab = thin_slab(8, 0.02);
  expect_equal_to_mixed_system(make_body("slab", slab, {{0, 0, 0}, {1, 0, 0}, {1, 1, 0.02}, {0.5, 0.5, 0.02}}, 0.45),
                               tolerance::mixed_system_of_a_slab);
}

TEST(ResponseTolerance, IsMetOnBodiesOfManyShapes) {
  for (const Body& body : bodies()) {
    const Answer exact = solve_mixed_system(body);
    for (const double requested : {1e-3, 1e-6, 1e-9}) {
      ResponseModel model(body.mesh, {body.poisson, requested, {}});
      model.add(landmarks_on(body.landmarks));
      EXPECT_LE(difference(model.response(), exact.R), requested) << body.name;
    }
  }
}

}  // namespace
}  // namespace skinbem
