// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What a run did: for people, and as one JSON object for programs.
#pragma once

#include <cstdint>
#include <optional>
#include <string>

namespace skinbem {

/// From a mesh to its response matrix. What a run does not have stays empty (iterations of a direct solver, Poisson's
/// ratio of a response that was read).
struct RunReport {
  std::string version;
  std::int64_t vertices = 0, triangles = 0;
  double volume = 0;  ///< of the body, cube of the mesh's unit
  int landmarks = 0;
  std::optional<double> poisson;
  std::string solver;  ///< `dense`, `hmatrix`, or `file` for a response that was read
  std::optional<double> tolerance;
  std::optional<double> estimated_error;  ///< of R, relative to its largest entry
  std::optional<double> residual;         ///< worst relative residual of a column
  std::optional<int> iterations;
  int threads = 1;
  struct Predicted {
    double seconds = 0;
    std::int64_t bytes = 0;
  };
  std::optional<Predicted> predicted;  ///< what the solver was expected to take
  struct Seconds {
    double read = 0, assemble = 0, factor = 0, solve = 0, total = 0;
  } seconds;
  std::int64_t peak_bytes = 0;
};

/// One JSON object on one line. The keys are a contract: version, mesh {vertices, triangles, volume}, landmarks,
/// poisson, solver, tolerance, estimated_error, residual, iterations, threads, seconds {read, assemble, factor, solve,
/// total}, peak_bytes, predicted {seconds, bytes}. What is empty is null. Throws Error(numerical) when a number is not
/// finite.
std::string to_json(const RunReport& report);

/// The same in a few lines for people.
std::string to_text(const RunReport& report);

/// Largest resident size of this process so far, in bytes; 0 where the system does not say.
std::int64_t peak_resident_bytes();

}  // namespace skinbem
