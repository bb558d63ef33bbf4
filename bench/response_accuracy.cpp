// SPDX-License-Identifier: BSD-3-Clause
// response_accuracy MESH LANDMARKS [R.npy]: for tolerances from 1e-2 to 1e-12, the error of R relative to its largest
// entry, what the model estimates, how well rotations are annihilated, and the time. The reference is R.npy
// (nu 0.45, radius 0, for these landmarks), else the model at 1e-12.
#include <chrono>
#include <cstdio>

#include <skinbem/io/npy.hpp>
#include <skinbem/mesh/mesh_io.hpp>
#include <skinbem/operator/collocation.hpp>
#include <skinbem/response/landmark_table.hpp>
#include <skinbem/response/response_model.hpp>
#include <skinbem/solve/rigid_modes.hpp>

namespace {

struct Measured {
  Eigen::MatrixXd R;
  skinbem::ResponseSummary summary;
  double seconds;
};

Measured measure(const skinbem::TriangleMesh& mesh, const std::vector<skinbem::Landmark>& landmarks, double tolerance) {
  const auto start = std::chrono::steady_clock::now();
  skinbem::ResponseModel model(mesh, {.poisson = 0.45, .tolerance = tolerance});
  model.add(landmarks);
  Measured result{model.response(), model.summary(), 0};
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
  return result;
}

/// max |H (w x X)| / max |w x X| over three rotations.
double rotation_residual(const skinbem::TriangleMesh& mesh, double tolerance) {
  const skinbem::Collocation<skinbem::Kelvin<double>> collocation(mesh, {.poisson = 0.45}, {.tolerance = tolerance});
  const Eigen::MatrixXd rotations = skinbem::rigid_modes(mesh.vertices).rightCols<3>();
  return (collocation.double_layer_matrix() * rotations).cwiseAbs().maxCoeff() / rotations.cwiseAbs().maxCoeff();
}

}  // namespace

int main(int argc, char** argv) try {
  if (argc < 3) {
    std::fprintf(stderr, "usage: response_accuracy MESH LANDMARKS [R.npy]\n");
    return 2;
  }
  const auto mesh = skinbem::read_mesh(argv[1]);
  const auto landmarks = skinbem::read_landmarks(argv[2], mesh, 0.0).landmarks;
  const Eigen::MatrixXd reference = argc > 3 ? skinbem::read_npy(argv[3]) : measure(mesh, landmarks, 1e-12).R;

  std::printf("| tolerance | error of R | estimated | \\|H (w x X)\\| | near pairs | assembly s | whole s |\n");
  std::printf("|---|---|---|---|---|---|---|\n");
  for (const double tolerance : {1e-2, 1e-3, 1e-4, 1e-5, 1e-6, 1e-8, 1e-10, 1e-12}) {
    const Measured m = measure(mesh, landmarks, tolerance);
    const double error = (m.R - reference).cwiseAbs().maxCoeff() / reference.cwiseAbs().maxCoeff();
    std::printf("| %.0e | %.1e | %.1e | %.1e | %.1f %% | %.3f | %.3f |\n", tolerance, error, m.summary.estimated_error,
                rotation_residual(mesh, tolerance), 100 * m.summary.near_share, m.summary.assemble_seconds, m.seconds);
  }
  return 0;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
