// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/solve/solver_choice.hpp>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <limits>
#include <sstream>
#include <string>

#include <skinbem/solve/coarse_correction.hpp>

namespace skinbem {
namespace {

/// Assembly a vertex-triangle pair, then LU in single precision refined in double.
SolverPrediction predict_dense(double n, double threads) {
  constexpr double seconds_per_pair = 6e-8, flops_per_second = 8e10;
  const double factorisation = 2.0 / 3 * std::pow(3 * n, 3);
  // the matrix in double, its factors in single precision
  return {Solver::dense, (seconds_per_pair * 2 * n * n + factorisation / flops_per_second) / threads,
          static_cast<std::size_t>(9 * n * n * (8 + 4 + 4) + 1e8)};
}

SolverPrediction predict_hmatrix(const TriangleMesh& mesh, double tolerance, double threads) {
  const double n = static_cast<double>(mesh.vertex_count());
  const IterativeOptions options = IterativeOptions::for_tolerance(tolerance, mesh.vertex_count());
  const double digits = -std::log10(tolerance);
  // measured on the leg of 10,000 vertices, one thread, 1e-2 to 1e-7: 2.7, 3.1, 3.7 (2e-4), 3.8 s from 128 samples of
  // a cluster, 6.2 from 256, 10.7, 15.7, 18.6 in double precision; grows by a fifth of a power: iterations and levels
  // (docs/scaling.md)
  const double for_numbers = options.compression.samples <= 128 ? 1 : options.single ? 1.4 : 3;
  const double seconds_per_vertex = for_numbers * (2e-4 + 5e-5 * digits) * std::pow(n / 1e4, 0.2);
  const double blocks_of_the_basis = 4 * digits, columns = 18;
  const double schwarz = 3 * n * 3 * 128 * 2;
  const double vectors = 3 * n * 8 * columns * (blocks_of_the_basis + 8);
  const double rows = 3 * n * 8 * 3 * 16;  // of the sample
  const double coarse = 3 * n * 2 * 6 * static_cast<double>(CoarseCorrection::parts_for(mesh.vertex_count()));  // A Z
  const double number_bytes = options.single ? 4 : 8;
  return {Solver::hmatrix, seconds_per_vertex * n / threads,
          predict_compressed_bytes(mesh, options.compression, static_cast<std::size_t>(number_bytes)) +
              static_cast<std::size_t>(schwarz + vectors + rows + coarse + 1e8)};
}

std::string gigabytes(std::size_t bytes) {
  std::ostringstream text;
  text.precision(2);
  text << std::fixed << static_cast<double>(bytes) * 1e-9 << " GB";
  return text.str();
}

}  // namespace

const char* name_of(Solver solver) {
  return solver == Solver::automatic ? "auto" : solver == Solver::dense ? "dense" : "hmatrix";
}

SolverPrediction predict_solver(Solver solver, const TriangleMesh& mesh, double tolerance, int threads) {
  return solver == Solver::dense ? predict_dense(static_cast<double>(mesh.vertex_count()), threads)
                                 : predict_hmatrix(mesh, tolerance, threads);
}

SolverPrediction choose_solver(Solver wanted, const TriangleMesh& mesh, double tolerance, int threads,
                               std::size_t memory_limit) {
  if (wanted == Solver::hmatrix && tolerance < finest_compression) {
    throw Error(ErrorCode::usage,
                "the compressed matrix reaches 1e-7; allow a larger tolerance or use the dense solver");
  }
  const std::size_t limit = memory_limit > 0 ? memory_limit : available_memory();
  std::vector<SolverPrediction> options;
  for (const Solver solver : {Solver::dense, Solver::hmatrix}) {
    if (wanted != Solver::automatic && wanted != solver) continue;
    if (solver == Solver::hmatrix && tolerance < finest_compression) continue;
    options.push_back(predict_solver(solver, mesh, tolerance, threads));
  }
  std::sort(options.begin(), options.end(), [](const auto& a, const auto& b) { return a.seconds < b.seconds; });
  std::string needs;
  for (const SolverPrediction& option : options) {
    if (option.bytes <= limit) return option;
    needs += std::string(needs.empty() ? "" : ", ") + name_of(option.solver) + " " + gigabytes(option.bytes);
  }
  throw Error(ErrorCode::usage,
              "not enough memory for " + std::to_string(mesh.vertex_count()) + " vertices: " + needs + " needed, " +
                  gigabytes(limit) + " there are; allow more memory, " +
                  (wanted == Solver::dense ? "use the compressed solver (hmatrix)" : "a larger tolerance") +
                  " or take a coarser mesh");
}

std::size_t available_memory() {
  std::ifstream file("/proc/meminfo");
  for (std::string line; std::getline(file, line);) {
    if (line.starts_with("MemAvailable:")) return std::stoull(line.substr(13)) * 1024;
  }
  return std::numeric_limits<std::size_t>::max();
}

}  // namespace skinbem
