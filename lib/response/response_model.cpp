// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/response/response_model.hpp>

#include <omp.h>

#include <algorithm>
#include <optional>
#include <sstream>
#include <utility>

#include <skinbem/base/lapack.hpp>
#include <skinbem/base/rigid_fit.hpp>
#include <skinbem/base/stopwatch.hpp>
#include <skinbem/hmatrix/exact_rows.hpp>
#include <skinbem/mesh/validate.hpp>
#include <skinbem/response/compression_error.hpp>
#include <skinbem/response/landmark_patch.hpp>
#include <skinbem/solve/rigid_modes.hpp>

namespace skinbem {
namespace {

Eigen::Map<const Points> as_points(const Eigen::Ref<const Eigen::VectorXd>& u) { return {u.data(), u.size() / 3, 3}; }

/// The part of the error of R that quadrature makes: the tolerance that every element integral keeps (a priori), or
/// what a rotation shows of it (a posteriori): measured over spheres, legs, boxes and slabs, R errs by 100 to 12,000
/// times |H (w x X)| / |w x X|.
constexpr double rotation_residual_to_error = 50000;
/// Ratio of the second to the first extent of landmarks: the error of a rotation about their line is its inverse.
constexpr double on_a_line = 1e-6;
/// Reciprocal condition of the landmarks' system: measured, 1e-4 to 1e-2 on the leg and on boxes, 4e-7 where a patch
/// is half of the leg, 1e-6 for three neighbouring vertices; below 1e-11 R errs by more than its tolerance.
constexpr double told_apart = 1e-11;
/// On the product of the size of the defects and what such defects do: measured, 0.9 to 2.5 times the error.
constexpr double safety = 1.5;
/// R errs at least seven times less than the tolerance of H (docs/accuracy.md).
constexpr double compressed_quadrature = 1.0 / 7;

void require_own_vertex(const Landmark& landmark, const Landmark& other) {
  if (landmark.vertex != other.vertex) return;
  throw Error(ErrorCode::bad_input, "landmarks " + other.name + " and " + landmark.name + " are both on vertex " +
                                        std::to_string(landmark.vertex) + "; move or remove one of them");
}

}  // namespace

void ResponseOptions::validate() const {
  if (!(poisson > -1 && poisson <= 0.5)) {
    throw Error(ErrorCode::usage, "Poisson's ratio must be greater than -1 and at most 0.5");
  }
  if (!(tolerance >= 1e-12 && tolerance <= 1e-1)) {
    throw Error(ErrorCode::usage, "the tolerance must lie between 1e-12 and 0.1");
  }
}

struct ResponseModel::State {
  TriangleMesh mesh;
  ResponseOptions options;
  Collocation<Kelvin<double>> collocation;
  IndexLists triangles_of_vertex;
  Eigen::VectorXd areas;
  Eigen::MatrixXd B;
  SharedCurvature curvature;              ///< where displacements are curved
  std::unique_ptr<NeumannSolver> solver;  ///< none while it is to be compressed anew
  std::vector<GreensFunctions> greens;
  std::vector<Landmark> landmarks;
  ResponseSummary summary;
  double quadrature_error = 0;
  double compressed_to;                       ///< tolerance, where H is compressed
  double residual = 0;                        ///< at which a column has converged there
  std::optional<CompressionDefects> defects;  ///< where H is compressed, from the first solve on
  bool answered = false;                      ///< random defects, by this H

  State(const TriangleMesh& body, const ResponseOptions& given)
      : mesh(body),
        options(given),
        collocation(mesh, Kelvin<double>{given.poisson, 1.0}, {given.tolerance}),
        triangles_of_vertex(triangles_around_vertices(mesh)),
        areas(vertex_areas(mesh)),
        B(rigid_modes(mesh.vertices)),
        curvature(given.displacements == Displacements::curved
                      ? std::make_shared<const RecoveredCurvature>(mesh, given.poisson)
                      : nullptr),
        compressed_to(given.tolerance) {
    summary.prediction =
        choose_solver(options.solver, mesh, options.tolerance, omp_get_max_threads(), options.memory_limit);
    summary.prediction.solver == Solver::dense ? make_dense() : make_compressed();
  }

  void make_dense() {
    Stopwatch watch;
    AssemblyCounts counts;
    RowMajorMatrix H = collocation.double_layer_matrix(options.progress, &counts);
    const double distance = integrate_carefully(collocation, H), wanted = options.tolerance * 1e-2;
    constexpr double smallest = 1e-12;  // well above rounding
    summary.near_share = double(counts.near) / double(counts.pairs);
    summary.assemble_seconds = watch.lap();
    report(options.progress, "factor", 0);
    solver = make_dense_solver(std::move(H), B, std::max(wanted * distance, std::min(wanted, smallest)), curvature);
    const double rotation_residual =
        solver->apply_H(B.rightCols<3>()).cwiseAbs().maxCoeff() / B.rightCols<3>().cwiseAbs().maxCoeff();
    quadrature_error = std::min(options.tolerance, rotation_residual_to_error * rotation_residual);
    report(options.progress, "factor", 1);
    summary.factor_seconds = watch.lap();
  }

  void make_compressed() {
    Stopwatch watch;
    const IterativeOptions iterative = iterative_options();
    solver = make_iterative_solver(mesh, collocation, B, iterative, options.progress, curvature);
    residual = iterative.residual;
    answered = false;
    ++summary.compressions;
    summary.assemble_seconds += watch.lap();
  }

  /// Compressed anew, in the next better precision: a body so loose shows rounding errors, too.
  IterativeOptions iterative_options() const {
    const IterativeOptions at_first = IterativeOptions::for_tolerance(options.tolerance, mesh.vertex_count());
    if (compressed_to == options.tolerance) return at_first;
    IterativeOptions anew = IterativeOptions::for_tolerance(compressed_to, mesh.vertex_count());
    anew.single = anew.single && at_first.compression.packed;
    return anew;
  }
  bool compressed() const { return summary.prediction.solver == Solver::hmatrix; }

  /// Iterates to a smaller residual, by `factor`; false where that is no longer possible.
  bool iterate_on(double factor) {
    constexpr double most = 1e-2;  // of what befits the compression
    if (residual <= most * iterative_options().residual) return false;
    residual *= factor;
    solver->set_residual(residual);
    return true;
  }

  /// Compresses less, by `factor`; false where that is no longer possible, or would not fit into memory.
  bool tighten(double factor) {
    constexpr double most = 1e-2;  // of the tolerance
    if (!compressed() || compressed_to <= std::max(finest_compression, most * options.tolerance)) return false;
    const double before = std::exchange(compressed_to, std::max(compressed_to * factor, finest_compression));
    constexpr double in_double = 1e-5;
    const double tolerance = iterative_options().single ? compressed_to : std::min(compressed_to, in_double);
    const std::size_t limit = options.memory_limit > 0 ? options.memory_limit : available_memory();
    if (predict_solver(Solver::hmatrix, mesh, tolerance, omp_get_max_threads()).bytes > limit) {
      compressed_to = before;
      return false;
    }
    solver.reset();
    return true;
  }

  void check(const Landmark& landmark, Index replaced) const {
    for (Index k = 0; k < Index(greens.size()); ++k) {
      if (k != replaced) require_own_vertex(landmark, greens[k].landmark);
    }
  }

  /// Where the compressed solver does not converge, once more with less compression.
  std::vector<GreensFunctions> solve(std::span<const Landmark> wanted) {
    for (;;) {
      try {
        return solve_once(wanted);
      } catch (const Error& error) {
        if (error.code() != ErrorCode::numerical || !tighten(0.1)) throw;
      }
    }
  }

  std::vector<GreensFunctions> solve_once(std::span<const Landmark> wanted) {
    if (!solver) make_compressed();  // anew
    Stopwatch watch;
    std::vector<GreensFunctions> made;
    Eigen::MatrixXd G(B.rows(), 3 * Index(wanted.size()));
    for (const Landmark& landmark : wanted) {
      made.push_back({landmark, make_patch(mesh, triangles_of_vertex, areas, landmark, options.loads), 0, {}, {}, {}});
      G.middleCols<3>(3 * Index(made.size() - 1)) = collocation.single_layer_columns(made.back().patch.traction);
    }
    if (curvature) G -= curved_part(made);
    for (std::size_t k = 0; k < made.size(); ++k) {
      auto columns = G.middleCols<3>(3 * Index(k));
      made[k].load = columns.norm();
      columns /= made[k].load;
    }
    SolveSummary ended;
    report(options.progress, "solve", 0);
    const Eigen::MatrixXd Y = solve_with_defects(G, ended);
    const Eigen::MatrixXd L = B.transpose() * Y;
    const Eigen::MatrixXd X = Y - B * L;
    const Eigen::MatrixXd left = defects ? defects_of(Y, L, G) : Eigen::MatrixXd(0, G.cols());
    for (std::size_t k = 0; k < made.size(); ++k) {
      made[k].X = X.middleCols<3>(3 * Index(k));
      made[k].L = L.middleCols<3>(3 * Index(k));
      made[k].defect = left.middleCols<3>(3 * Index(k));
    }
    report(options.progress, "solve", 1);
    summary.iterations = std::max(summary.iterations, ended.iterations);
    summary.residual = std::max(summary.residual, ended.residual);
    summary.solve_seconds += watch.lap();
    return made;
  }

  /// What the curvature under unit tractions at each landmark takes from their G: (H - C) S_t t.
  Eigen::MatrixXd curved_part(const std::vector<GreensFunctions>& loaded) const {
    Eigen::MatrixXd s(B.rows(), 3 * Index(loaded.size()));
    for (std::size_t k = 0; k < loaded.size(); ++k) {
      s.middleCols<3>(3 * Index(k)) = curvature->of_tractions(loaded[k].patch.traction);
    }
    return solver->apply_H(s) - curvature->free_part(s);
  }

  /// What compression and iteration leave of the system's equations.
  Eigen::MatrixXd defects_of(const Eigen::MatrixXd& Y, const Eigen::MatrixXd& L, const Eigen::MatrixXd& G) const {
    if (!curvature) return defects->of(Y, L, G);
    const Eigen::MatrixXd s = curvature->of_displacements(Y);
    return defects->of(Y + s, L, G + curvature->free_part(s));
  }

  /// The first time on a compressed H, random defects are solved for beside G.
  Eigen::MatrixXd solve_with_defects(const Eigen::MatrixXd& G, SolveSummary& ended) {
    if (!compressed() || answered) return solver->solve(G, &ended);
    const Eigen::MatrixXd random = solver->random_defects();
    Eigen::MatrixXd both(G.rows(), G.cols() + random.cols());
    both << G, random;
    const Eigen::MatrixXd Y = solver->solve(both, &ended);
    if (defects) {
      defects->set_answers(Y.rightCols(random.cols()));
    } else {
      defects.emplace(collocation, B, Y.rightCols(random.cols()));
    }
    answered = true;
    return Y.leftCols(G.cols());
  }

  Points positions() const {
    Points p(Index(greens.size()), 3);
    for (Index k = 0; k < p.rows(); ++k) p.row(k) = greens[k].patch.measure(mesh.vertices).transpose();
    return p;
  }

  void keep_names_and_estimate() {
    landmarks.clear();
    for (const GreensFunctions& g : greens) landmarks.push_back(g.landmark);
    summary.estimated_error = estimated_error();
  }

  /// X and L of all landmarks side by side.
  Eigen::MatrixXd all_X() const {
    Eigen::MatrixXd X(B.rows(), 3 * Index(greens.size()));
    for (std::size_t k = 0; k < greens.size(); ++k) X.middleCols<3>(3 * Index(k)) = greens[k].X;
    return X;
  }

  /// m_k of each column of a 3N by #columns field: 3Nk by #columns.
  Eigen::MatrixXd measure(const Eigen::MatrixXd& fields) const {
    Eigen::MatrixXd measured(3 * Index(greens.size()), fields.cols());
    for (Index c = 0; c < fields.cols(); ++c) {
      for (std::size_t k = 0; k < greens.size(); ++k) {
        measured.block<3, 1>(3 * Index(k), c) = greens[k].patch.measure(as_points(fields.col(c)));
      }
    }
    return measured;
  }

  /// The solutions (t; a) of the small system for unit displacements: 3Nk + 6 by 3Nk.
  Eigen::MatrixXd coefficients(const Eigen::MatrixXd& X) const {
    const Index n = X.cols();
    require_enough_landmarks();
    Eigen::MatrixXd transposed = Eigen::MatrixXd::Zero(n + 6, n + 6), inverse = Eigen::MatrixXd::Identity(n + 6, n + 6);
    transposed.topLeftCorner(n, n) = measure(X).transpose();
    transposed.bottomLeftCorner(6, n) = measure(B).transpose();
    for (Index k = 0; k < Index(greens.size()); ++k) transposed.block<3, 6>(3 * k, n) = greens[k].L.transpose();
    const double size = transposed.cwiseAbs().colwise().sum().maxCoeff();
    const bool regular = lapack::solve_transposed(transposed, inverse);
    if (!regular || !(size * inverse.cwiseAbs().rowwise().sum().maxCoeff() < 1 / told_apart)) {
      throw Error(ErrorCode::bad_input,
                  "the landmarks cannot be told apart: they are too near to each other, or so wide that they share one "
                  "patch; lower the radius, check its unit, or move the landmarks");
    }
    return inverse.leftCols(n);
  }

  /// After a change of landmarks: estimates the error of R, and does better where it is too large. Throws
  /// Error(numerical) where that does not help.
  void settle() {
    constexpr double hopeless = 10;  // times the tolerance
    keep_names_and_estimate();
    while (compressed() && summary.estimated_error > allowed_error() && do_better()) {
      summary.residual = 0;
      greens = solve(landmarks);
      summary.estimated_error = estimated_error();
    }
    if (compressed() && summary.estimated_error > hopeless * options.tolerance) {
      std::ostringstream message;
      message << "the response is estimated to err by " << summary.estimated_error << " instead of "
              << options.tolerance << " (residual " << summary.residual
              << "): the body bends too easily for a compressed matrix; " << solver->advice();
      throw Error(ErrorCode::numerical, message.str());
    }
  }

  /// Of the estimate, which is twice the error and more. The rounding of 16 bits has a part in it, but differs from
  /// vertex to vertex, and a body hardly answers to that.
  double allowed_error() const { return (iterative_options().compression.packed ? 3 : 1.5) * options.tolerance; }

  /// Iterates on where the compression is good enough, else compresses less; false where neither is possible.
  bool do_better() {
    Eigen::MatrixXd X = all_X();
    if (curvature) X += curvature->of_displacements(X);
    const double compression = estimated_error(defects->of_compression(X, solver->apply_H(X)));
    const double room = (allowed_error() - compression) / summary.estimated_error;  // for the iteration's share
    return (room > 0 && iterate_on(std::clamp(room / 2, 0.02, 0.3))) ||
           tighten(std::clamp(options.tolerance / compression, 0.05, 0.3));
  }

  double estimated_error() const {
    if (!compressed()) return quadrature_error + summary.residual;
    if (!enough_landmarks()) return 0;
    Eigen::MatrixXd left(greens.front().defect.rows(), 3 * Index(greens.size()));
    for (std::size_t k = 0; k < greens.size(); ++k) left.middleCols<3>(3 * Index(k)) = greens[k].defect;
    return estimated_error(left);
  }

  /// Where so much is left of the equations of all landmarks.
  double estimated_error(const Eigen::MatrixXd& left) const {
    const Eigen::MatrixXd X = all_X(), solution = coefficients(X);
    const Eigen::MatrixXd& answers = defects->answers();
    const Eigen::MatrixXd coefficients_of_answers = solution * measure(answers);
    const Eigen::MatrixXd held =
        answers - X * coefficients_of_answers.topRows(X.cols()) - B * coefficients_of_answers.bottomRows<6>();
    return options.tolerance * compressed_quadrature +
           safety * CompressionDefects::size(left * solution.topRows(X.cols())) * held.cwiseAbs().maxCoeff();
  }

  bool enough_landmarks() const { return greens.size() >= 3 && collinear_measure(positions()) >= on_a_line; }

  void require_enough_landmarks() const {
    if (greens.size() < 3) {
      throw Error(ErrorCode::bad_input,
                  std::to_string(greens.size()) +
                      " landmarks: at least three that are not on a line are needed, or the body is "
                      "free to turn; add landmarks");
    }
    if (!enough_landmarks()) {
      throw Error(ErrorCode::bad_input,
                  "the landmarks lie on a line, so that the body is free to turn about it; add or move a landmark");
    }
  }
};

ResponseModel::ResponseModel(const TriangleMesh& mesh, const ResponseOptions& options) {
  options.validate();
  constexpr double largest_with_cavities = 0.49;
  if (options.poisson > largest_with_cavities && inspect(mesh).topology.cavities > 0) {
    throw Error(ErrorCode::bad_input,
                "the body has a cavity, whose volume an almost incompressible material keeps: the equations are close "
                "to singular "
                "above Poisson's ratio 0.49; lower it to 0.49 or fill the cavity");
  }
  state_ = std::make_unique<State>(mesh, options);
}
ResponseModel::~ResponseModel() = default;
ResponseModel::ResponseModel(ResponseModel&&) noexcept = default;
ResponseModel& ResponseModel::operator=(ResponseModel&&) noexcept = default;

void ResponseModel::add(std::span<const Landmark> landmarks) {
  if (landmarks.empty()) return;
  for (std::size_t k = 0; k < landmarks.size(); ++k) {
    state_->check(landmarks[k], -1);
    for (std::size_t other = 0; other < k; ++other) require_own_vertex(landmarks[k], landmarks[other]);
  }
  const std::size_t before = state_->greens.size();
  for (GreensFunctions& g : state_->solve(landmarks)) state_->greens.push_back(std::move(g));
  try {
    state_->settle();
  } catch (...) {
    state_->greens.resize(before);
    state_->keep_names_and_estimate();
    throw;
  }
}

void ResponseModel::move(Index k, const Landmark& landmark) {
  if (k < 0 || k >= Index(state_->greens.size())) throw Error(ErrorCode::usage, "no landmark of that number to move");
  state_->check(landmark, k);
  GreensFunctions made = std::move(state_->solve(std::span(&landmark, 1)).front());
  std::swap(state_->greens[k], made);
  try {
    state_->settle();
  } catch (...) {
    std::swap(state_->greens[k], made);
    state_->keep_names_and_estimate();
    throw;
  }
}

void ResponseModel::remove(Index k) {
  if (k < 0 || k >= Index(state_->greens.size())) throw Error(ErrorCode::usage, "no landmark of that number to remove");
  state_->greens.erase(state_->greens.begin() + k);
  state_->keep_names_and_estimate();
}

std::vector<GreensFunctions> ResponseModel::greens_functions(std::span<const Landmark> landmarks) {
  if (landmarks.empty()) return {};
  return state_->solve(landmarks);
}

const std::vector<Landmark>& ResponseModel::landmarks() const { return state_->landmarks; }

Points ResponseModel::landmark_positions() const { return state_->positions(); }

Eigen::MatrixXd ResponseModel::response() const {
  const Eigen::MatrixXd X = state_->all_X();
  const Eigen::MatrixXd solution = state_->coefficients(X);
  Eigen::MatrixXd R = state_->B * solution.bottomRows<6>();
  lapack::add_product(X, solution.topRows(X.cols()), R);
  if (!R.allFinite()) throw Error(ErrorCode::numerical, "the response is not finite; check the mesh's coordinates");
  return R;
}

Eigen::MatrixXd ResponseModel::tractions() const {
  const Eigen::MatrixXd X = state_->all_X();
  Eigen::MatrixXd t = state_->coefficients(X).topRows(X.cols());
  for (std::size_t k = 0; k < state_->greens.size(); ++k) t.middleRows<3>(3 * Index(k)) /= state_->greens[k].load;
  return t;
}

const TriangleMesh& ResponseModel::mesh() const { return state_->mesh; }
const ResponseSummary& ResponseModel::summary() const { return state_->summary; }

}  // namespace skinbem
