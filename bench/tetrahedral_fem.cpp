// SPDX-License-Identifier: BSD-3-Clause
#include "tetrahedral_fem.hpp"

#include <omp.h>

#include <Eigen/LU>
#include <Eigen/QR>
#include <array>
#include <skinbem/base/error.hpp>
#include <skinbem/base/stopwatch.hpp>
#include <skinbem/solve/rigid_modes.hpp>
#include <utility>

#include "stiffness_matrix.hpp"

namespace skinbem::bench {
namespace {

/// The six degrees of freedom on the skin that determine a rigid motion best.
std::array<Index, 6> held_by(const Eigen::MatrixXd& B) {
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> qr(B.transpose());
  std::array<Index, 6> held;
  for (Index k = 0; k < 6; ++k) held[static_cast<std::size_t>(k)] = qr.colsPermutation().indices()[k];
  return held;
}

/// Sets the number of threads of the BLAS for its lifetime.
class Threads {
 public:
  explicit Threads(int count) : before_(omp_get_max_threads()) { omp_set_num_threads(count); }
  ~Threads() { omp_set_num_threads(before_); }
  Threads(const Threads&) = delete;
  Threads& operator=(const Threads&) = delete;

 private:
  int before_;
};

/// The three unit loads of a landmark: 3N by 3.
Eigen::MatrixXd unit_loads(const TriangleMesh& skin, const LandmarkPatch& patch) {
  const Eigen::VectorXd forces = loads_of_vertices(skin, patch.traction);
  Eigen::MatrixXd loads = Eigen::MatrixXd::Zero(3 * skin.vertex_count(), 3);
  for (Index i = 0; i < forces.rows(); ++i) loads.block<3, 3>(3 * i, 0).diagonal().setConstant(forces[i]);
  return loads;
}

/// m_k of each column of a 3N by #columns field: 3Nk by #columns.
Eigen::MatrixXd measure(const std::vector<LandmarkPatch>& patches, const Eigen::MatrixXd& fields) {
  Eigen::MatrixXd measured(3 * Index(patches.size()), fields.cols());
  for (Index c = 0; c < fields.cols(); ++c) {
    const Eigen::Map<const Points> field(fields.col(c).data(), fields.rows() / 3, 3);
    for (std::size_t k = 0; k < patches.size(); ++k) {
      measured.block<3, 1>(3 * Index(k), c) = patches[k].measure(field);
    }
  }
  return measured;
}

}  // namespace

struct TetrahedralFem::State {
  TriangleMesh skin;
  TetrahedralFemOptions options;
  TetrahedralFemSummary summary;
  Eigen::MatrixXd B;
  std::array<Index, 6> held;
  std::unique_ptr<CholeskyFactor> factor;

  State(const TriangleMesh& given, const TetrahedralFemOptions& wanted)
      : skin(given), options(wanted), B(rigid_modes(skin.vertices)), held(held_by(B)) {
    if (!(options.poisson > -1 && options.poisson < 0.5)) {
      throw Error(ErrorCode::usage, "finite elements need a Poisson's ratio greater than -1 and less than 0.5");
    }
    Stopwatch watch;
    const TetrahedralMesh mesh = fill_with_tetrahedra(skin, options.quality);
    summary.nodes = mesh.nodes.rows();
    summary.tetrahedra = mesh.tetrahedra.rows();
    summary.mesh_seconds = watch.lap();
    const IndexLists neighbours = lower_neighbours(mesh, tetrahedra_around_nodes(mesh));
    LowerTriangle K = stiffness_matrix(mesh, neighbours, options.poisson, held);
    summary.assemble_seconds = watch.lap();
    const Threads guard(options.factor_threads);
    factor = std::make_unique<CholeskyFactor>(std::move(K), neighbours);
    summary.factor_bytes = factor->bytes();
    summary.factor_seconds = watch.lap();
  }
};

TetrahedralFem::TetrahedralFem(const TriangleMesh& skin, const TetrahedralFemOptions& options)
    : state_(std::make_unique<State>(skin, options)) {}
TetrahedralFem::~TetrahedralFem() = default;

Eigen::MatrixXd TetrahedralFem::displacements(const Eigen::MatrixXd& forces) {
  Stopwatch watch;
  const Threads guard(state_->options.factor_threads);
  Eigen::MatrixXd loads = Eigen::MatrixXd::Zero(3 * state_->summary.nodes, forces.cols());
  loads.topRows(forces.rows()) = forces;
  for (const Index i : state_->held) loads.row(i).setZero();
  const Eigen::MatrixXd u = state_->factor->solve(loads).topRows(forces.rows());
  state_->summary.solve_seconds += watch.lap();
  return u;
}

// As ResponseModel: displacements X of unit loads, of which those in equilibrium, L t = 0, and a rigid motion B a make
// the prescribed measurements.
Eigen::MatrixXd TetrahedralFem::response(std::span<const Landmark> landmarks) {
  const TriangleMesh& skin = state_->skin;
  const IndexLists triangles = triangles_around_vertices(skin);
  const Eigen::VectorXd areas = vertex_areas(skin);
  const Index n = 3 * Index(landmarks.size());
  std::vector<LandmarkPatch> patches;
  Eigen::MatrixXd forces(3 * skin.vertex_count(), n);
  for (const Landmark& landmark : landmarks) {
    auto columns = forces.middleCols<3>(3 * Index(patches.size()));
    patches.push_back(make_patch(skin, triangles, areas, landmark, state_->options.loads));
    columns = unit_loads(skin, patches.back());
    columns /= columns.norm();
  }
  const Eigen::MatrixXd X = displacements(forces);
  Eigen::MatrixXd system = Eigen::MatrixXd::Zero(n + 6, n + 6);
  system << measure(patches, X), measure(patches, state_->B), state_->B.transpose() * forces,
      Eigen::MatrixXd::Zero(6, 6);
  const Eigen::MatrixXd solution = system.partialPivLu().solve(Eigen::MatrixXd::Identity(n + 6, n));
  return X * solution.topRows(n) + state_->B * solution.bottomRows<6>();
}

const TetrahedralFemSummary& TetrahedralFem::summary() const { return state_->summary; }

}  // namespace skinbem::bench
