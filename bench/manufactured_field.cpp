// SPDX-License-Identifier: BSD-3-Clause
#include "manufactured_field.hpp"

#include <omp.h>

#include <skinbem/base/stopwatch.hpp>
#include <skinbem/operator/collocation.hpp>
#include <skinbem/quadrature/near_singular.hpp>
#include <skinbem/quadrature/triangle_rules.hpp>
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

/// Calls visit(y, hat functions there, weight, traction) at the points of a rule on triangle t; the weights' sum is its
/// area.
template <class Visit>
void for_each_traction(const TriangleMesh& skin, const PointLoad& field, Index t, int degree, const Visit& visit) {
  const TriangleRule& rule = symmetric_triangle_rule(degree);
  const double area = area_vector(skin, t).norm() / 2;
  for (int q = 0; q < rule.size(); ++q) {
    const Vec3 hats = rule.barycentric.col(q);
    const Vec3 y = hats[0] * skin.corner(t, 0) + hats[1] * skin.corner(t, 1) + hats[2] * skin.corner(t, 2);
    visit(y, hats, rule.weights[q] * area, field.traction(y, area_vector(skin, t).normalized()));
  }
}

/// A triangle under the field's exact tractions: as a few forces, for points that are far, farther and very far.
class LoadedTriangle {
 public:
  LoadedTriangle(const TriangleMesh& skin, const PointLoad& field, Index t)
      : field_(field), source_(skin.corner(t, 0), skin.corner(t, 1), skin.corner(t, 2)) {
    for (const Vec3& corner : source_.geometry.vertices) centroid_ += corner / 3;
    for (const Vec3& corner : source_.geometry.vertices) radius_ = std::max(radius_, (corner - centroid_).norm());
    for (std::size_t k = 0; k < degrees.size(); ++k) {
      for_each_traction(skin, field, t, degrees[k],
                        [&](const Vec3& y, const Vec3&, double weight, const Vec3& traction) {
                          forces_[k].push_back({y, weight * traction});
                        });
    }
  }

  /// int U t dS at x.
  Vec3 displacement(const Vec3& x) const {
    const Kelvin<double> kernel{field_.poisson, 1.0};
    const double distance = (x - centroid_).norm() / radius_;
    Vec3 sum = Vec3::Zero();
    if (distance >= from.front()) {
      const std::size_t k = distance < from[1] ? 0 : distance < from[2] ? 1 : 2;
      for (const auto& [y, force] : forces_[k]) sum += kernel.single_layer(y - x) * force;
      return sum;
    }
    constexpr double tolerance = 1e-6;
    const NearSingularRule near(source_.geometry, x, tolerance);
    near.for_each([&](const Vec3& turned, const Vec3&, double weight) {
      const Vec3 r = near.frame().transpose() * turned;
      sum += kernel.single_layer(r) * field_.traction(x + r, source_.geometry.normal) * weight;
    });
    return sum;
  }

 private:
  static constexpr std::array<double, 3> from{3, 8, 30};  ///< radii
  static constexpr std::array<int, 3> degrees{8, 5, 2};

  struct Force {
    Vec3 place, force;
  };

  const PointLoad& field_;
  SourceTriangle source_;
  Vec3 centroid_ = Vec3::Zero();
  double radius_ = 0;
  std::array<std::vector<Force>, 3> forces_;
};

/// G t, int U t dS at every vertex.
Eigen::VectorXd single_layer(const TriangleMesh& skin, const PointLoad& field) {
  std::vector<LoadedTriangle> triangles;
  for (Index t = 0; t < skin.triangle_count(); ++t) triangles.emplace_back(skin, field, t);
  Eigen::VectorXd sum = Eigen::VectorXd::Zero(3 * skin.vertex_count());
#pragma omp parallel for schedule(dynamic, 8)
  for (Index k = 0; k < skin.vertex_count(); ++k) {
    const Vec3 x = skin.vertices.row(k);
    for (const LoadedTriangle& triangle : triangles) sum.segment<3>(3 * k) += triangle.displacement(x);
  }
  return sum;
}

constexpr int precise = 8;  ///< degree for integrals of tractions alone

Points mean_tractions(const TriangleMesh& skin, const PointLoad& field) {
  Points mean = Points::Zero(skin.triangle_count(), 3);
  for (Index t = 0; t < skin.triangle_count(); ++t) {
    const double area = area_vector(skin, t).norm() / 2;
    for_each_traction(skin, field, t, precise, [&](const Vec3&, const Vec3&, double weight, const Vec3& traction) {
      mean.row(t) += weight / area * traction.transpose();
    });
  }
  return mean;
}

/// int N_i t dS, N by 3.
Points nodal_forces(const TriangleMesh& skin, const PointLoad& field) {
  Points forces = Points::Zero(skin.vertex_count(), 3);
  for (Index t = 0; t < skin.triangle_count(); ++t) {
    for_each_traction(skin, field, t, precise, [&](const Vec3&, const Vec3& hats, double weight, const Vec3& traction) {
      for (int c = 0; c < 3; ++c) forces.row(skin.triangles(t, c)) += weight * hats[c] * traction.transpose();
    });
  }
  return forces;
}

std::unique_ptr<NeumannSolver> make_solver(Solver choice, const TriangleMesh& skin, const Eigen::MatrixXd& B,
                                           const ResponseCase& c, const SharedCurvature& curvature) {
  const Collocation<Kelvin<double>> collocation(skin, {c.poisson, 1.0}, {c.tolerance});
  if (choice == Solver::dense) {
    return make_dense_solver(collocation.double_layer_matrix(), B, 1e-2 * c.tolerance, curvature);
  }
  return make_iterative_solver(skin, collocation, B, IterativeOptions::for_tolerance(c.tolerance, skin.vertex_count()),
                               {}, curvature);
}

Solution by_boundary_elements(const TriangleMesh& skin, const PointLoad& field, const ResponseCase& c) {
  Stopwatch watch;
  const Eigen::MatrixXd B = rigid_modes(skin.vertices);
  const Solver choice = choose_solver(Solver::automatic, skin, c.tolerance, c.threads, 0).solver;
  SharedCurvature curvature;
  if (c.displacements == Displacements::curved) {
    curvature = std::make_shared<const RecoveredCurvature>(skin, c.poisson);
  }
  const auto solver = make_solver(choice, skin, B, c, curvature);
  const double prepare = watch.lap();
  Eigen::MatrixXd load = single_layer(skin, field);
  const double load_seconds = watch.lap();
  if (curvature) {
    const Eigen::MatrixXd s = curvature->of_tractions(mean_tractions(skin, field));
    load -= solver->apply_H(s) - curvature->free_part(s);
  }
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
Solution by_finite_elements(const TriangleMesh& skin, const PointLoad& field, const ResponseCase& c) {
  Stopwatch watch;
  TetrahedralFem fem(skin, {.poisson = c.poisson, .quality = c.quality});
  const Eigen::MatrixXd B = rigid_modes(skin.vertices);
  const Eigen::VectorXd forces = as_column(nodal_forces(skin, field));
  // In equilibrium but for what the rule loses, which is spread over all vertices.
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
Solution by_finite_elements(const TriangleMesh&, const PointLoad&, const ResponseCase&) {
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

Vec3 PointLoad::traction(const Vec3& x, const Vec3& normal) const {
  return Kelvin<double>{poisson, 1.0}.double_layer(x - place, normal).transpose() * load;
}

nlohmann::json measure_manufactured(const TriangleMesh& skin, const PointLoad& field, const ResponseCase& c,
                                    const ChildLimits& limits) {
  const auto work = [&] {
    omp_set_num_threads(c.threads);
    Solution solution = c.method == Method::boundary_elements ? by_boundary_elements(skin, field, c)
                                                              : by_finite_elements(skin, field, c);
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
