// SPDX-License-Identifier: BSD-3-Clause
#include "manufactured_field.hpp"

#include <omp.h>

#include <skinbem/base/stopwatch.hpp>
#include <skinbem/operator/collocation.hpp>
#include <skinbem/solve/rigid_modes.hpp>
#include <skinbem/solve/solver_choice.hpp>

#ifdef SKINBEM_BENCH_RIVAL
#include "tetrahedral_fem.hpp"
#endif

namespace skinbem::bench {
namespace {

/// A displacement of the skin, 3N, and how it was reached.
struct Solution {
  Eigen::MatrixXd u;
  nlohmann::json facts;
};

Eigen::VectorXd as_column(const Points& field) { return field.reshaped<Eigen::RowMajor>(); }

/// G t, int U t dS at every vertex, for tractions that jump between triangles.
Eigen::VectorXd single_layer(const TriangleMesh& skin, const Points& tractions, double poisson, double tolerance) {
  const ElementIntegral<Kelvin<double>> integral({poisson, 1.0}, tolerance);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(3 * skin.vertex_count());
#pragma omp parallel for schedule(dynamic, 8)
  for (Index k = 0; k < skin.vertex_count(); ++k) {
    for (Index t = 0; t < skin.triangle_count(); ++t) {
      const SourceTriangle source(skin.corner(t, 0), skin.corner(t, 1), skin.corner(t, 2));
      const auto blocks = integral.single_layer(source, skin.vertices.row(k).transpose());
      for (int c = 0; c < 3; ++c) sum.segment<3>(3 * k) += blocks[c] * tractions.row(3 * t + c).transpose();
    }
  }
  return sum;
}

std::unique_ptr<NeumannSolver> make_solver(Solver choice, const TriangleMesh& skin, const Eigen::MatrixXd& B,
                                           const ResponseCase& c) {
  const Collocation<Kelvin<double>> collocation(skin, {c.poisson, 1.0}, {c.tolerance});
  if (choice == Solver::dense) return make_dense_solver(collocation.double_layer_matrix(), B, 1e-2 * c.tolerance);
  return make_iterative_solver(skin, collocation, B, IterativeOptions::for_tolerance(c.tolerance, skin.vertex_count()));
}

Solution by_boundary_elements(const TriangleMesh& skin, const Points& tractions, const ResponseCase& c) {
  Stopwatch watch;
  const Eigen::MatrixXd B = rigid_modes(skin.vertices);
  const Solver choice = choose_solver(Solver::automatic, skin, c.tolerance, c.threads, 0).solver;
  const auto solver = make_solver(choice, skin, B, c);
  const double prepare = watch.lap();
  const Eigen::VectorXd load = single_layer(skin, tractions, c.poisson, c.tolerance);
  const double load_seconds = watch.lap();
  SolveSummary ended;
  const Eigen::MatrixXd u = solver->solve(load, &ended);
  const double solve = watch.lap();
  return {u,
          {{"unknowns", 3 * skin.vertex_count()},
           {"solver", name_of(choice)},
           {"iterations", ended.iterations},
           {"residual", ended.residual},
           {"seconds", {{"prepare", prepare}, {"load", load_seconds}, {"solve", solve}, {"total", prepare + solve}}}}};
}

#ifdef SKINBEM_BENCH_RIVAL
Solution by_finite_elements(const TriangleMesh& skin, const Points& tractions, const ResponseCase& c) {
  Stopwatch watch;
  TetrahedralFem fem(skin, {.poisson = c.poisson, .quality = c.quality});
  const Eigen::MatrixXd B = rigid_modes(skin.vertices);
  const Eigen::VectorXd forces = as_column(consistent_forces(skin, tractions));
  // In equilibrium but for what linear interpolation loses, which is spread over all vertices.
  const Eigen::MatrixXd balanced = forces - B * (B.transpose() * forces);
  Solution solution{fem.displacements(balanced), {}};
  const TetrahedralFemSummary& s = fem.summary();
  solution.facts = {{"unknowns", 3 * s.nodes},
                    {"seconds",
                     {{"mesh", s.mesh_seconds},
                      {"assemble", s.assemble_seconds},
                      {"factor", s.factor_seconds},
                      {"solve", s.solve_seconds},
                      {"total", watch.lap()}}}};
  return solution;
}
#else
Solution by_finite_elements(const TriangleMesh&, const Points&, const ResponseCase&) {
  throw Error(ErrorCode::usage, "finite elements were not compiled in (SKINBEM_BENCH_RIVAL)");
}
#endif

}  // namespace

Points PointLoad::displacements(const TriangleMesh& skin) const {
  const Kelvin<double> kernel{poisson, 1.0};
  Points u = skin.vertices;
  for (Index i = 0; i < u.rows(); ++i) {
    u.row(i) = kernel.single_layer(skin.vertices.row(i).transpose() - place).transpose() * load;
  }
  return u;
}

Points PointLoad::tractions(const TriangleMesh& skin) const {
  const Kelvin<double> kernel{poisson, 1.0};
  Points result(3 * skin.triangle_count(), 3);
  for (Index t = 0; t < skin.triangle_count(); ++t) {
    const Vec3 normal = area_vector(skin, t).normalized();
    for (int c = 0; c < 3; ++c) {
      result.row(3 * t + c) = kernel.double_layer(skin.corner(t, c) - place, normal).transpose() * load;
    }
  }
  return result;
}

nlohmann::json measure_manufactured(const TriangleMesh& skin, const PointLoad& field, const ResponseCase& c,
                                    const ChildLimits& limits) {
  const auto work = [&] {
    omp_set_num_threads(c.threads);
    const Points tractions = field.tractions(skin);
    Solution solution = c.method == Method::boundary_elements ? by_boundary_elements(skin, tractions, c)
                                                              : by_finite_elements(skin, tractions, c);
    const Eigen::MatrixXd B = rigid_modes(skin.vertices);
    const auto without_rigid = [&](const Eigen::MatrixXd& u) { return Eigen::MatrixXd(u - B * (B.transpose() * u)); };
    const Eigen::MatrixXd exact = without_rigid(as_column(field.displacements(skin)));
    solution.facts.update(errors_of(without_rigid(solution.u), exact));
    return solution.facts;
  };
  return described(run_in_child(work, limits), "limb", skin.vertex_count(), c);
}

nlohmann::json errors_of(const Eigen::MatrixXd& u, const Eigen::MatrixXd& exact) {
  return {{"rms_error", (u - exact).norm() / exact.norm()},
          {"max_error", (u - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff()}};
}

}  // namespace skinbem::bench
