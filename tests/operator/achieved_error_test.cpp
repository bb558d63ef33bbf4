// SPDX-License-Identifier: BSD-3-Clause
// What tolerance asks of H is what H has: no worse, and not a hundred times better, which would be paid for.
#include <gtest/gtest.h>

#include <skinbem/operator/collocation.hpp>

#include "files.hpp"
#include "meshes.hpp"
#include "reference_data.hpp"
#include "tolerances.hpp"

namespace skinbem {
namespace {

using namespace testing_support;

/// The largest error of an entry relative to the largest exact entry of its 3 x 3 block.
double error_of_blocks(const RowMajorMatrix& H, const RowMajorMatrix& exact) {
  double worst = 0;
  for (Index i = 0; i < exact.rows(); i += 3) {
    for (Index j = 0; j < exact.cols(); j += 3) {
      const Mat3 block = exact.block<3, 3>(i, j);
      const double error = (H.block<3, 3>(i, j) - block).cwiseAbs().maxCoeff();
      worst = std::max(worst, error / block.cwiseAbs().maxCoeff());
    }
  }
  return worst;
}

void expect_error_within_two_decades_below_the_tolerance(const TriangleMesh& mesh) {
  const Kelvin<double> kernel{0.45, 1.0};
  const RowMajorMatrix exact = Collocation<Kelvin<double>>(mesh, kernel, {smallest_tolerance}).double_layer_matrix();
  for (int digits = 3; digits <= 12; ++digits) {
    const double requested = std::pow(10.0, -digits);
    const double error =
        error_of_blocks(Collocation<Kelvin<double>>(mesh, kernel, {requested}).double_layer_matrix(), exact);
    EXPECT_LE(error, requested);
    EXPECT_GE(error, requested * tolerance::waste);
  }
}

TEST(AchievedErrorOfH, IsTheToleranceWithinTwoDecadesOnASphere) {
  expect_error_within_two_decades_below_the_tolerance(icosphere(2));
}

TEST(AchievedErrorOfH, IsTheToleranceWithinTwoDecadesOnACube) {
  expect_error_within_two_decades_below_the_tolerance(cube(6));
}

TEST(AchievedErrorOfH, IsTheToleranceWithinTwoDecadesOnAThinSlab) {
  expect_error_within_two_decades_below_the_tolerance(thin_slab(8));
}

TEST(AchievedErrorOfH, IsTheToleranceWithinTwoDecadesOnTheLeg) {
  expect_error_within_two_decades_below_the_tolerance(read_reference_obj(project_file("data/lower_limb/skin.obj")));
}

}  // namespace
}  // namespace skinbem
