// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A response matrix by either method, timed in a process of its own: what the programs on scaling measure.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <skinbem/mesh/triangle_mesh.hpp>
#include <skinbem/response/response_model.hpp>

#include "measured_child.hpp"

namespace skinbem::bench {

/// A body with its landmarks.
struct Skin {
  std::string family;  ///< "limb": the skin that is shipped, subdivided; "given": files of --skins
  TriangleMesh mesh;
  std::vector<Landmark> landmarks;
};

/// The limb of `data/lower_limb` with 0 to `times` subdivisions (subdivision.hpp) and its landmarks, whose vertices are
/// the same in all. Throws Error.
std::vector<Skin> limb_skins(const std::filesystem::path& data, int times, double radius);
/// The skins skin*.obj of a folder with their landmarks of landmarks.csv, by rising number of vertices. Throws Error.
std::vector<Skin> given_skins(const std::filesystem::path& folder, double radius);

enum class Method { boundary_elements, finite_elements };
/// "bem", "fem".
const char* name_of(Method method);
/// Finite elements only where they were compiled in.
std::vector<Method> methods();

struct ResponseCase {
  Method method = Method::boundary_elements;
  double poisson = 0.45;
  double tolerance = 2e-4;                              ///< of boundary elements
  Displacements displacements = Displacements::linear;  ///< of boundary elements
  Loads loads = Loads::linear;
  std::string quality = "q";  ///< of finite elements: TetGen's switches
  int threads = 1;
  std::filesystem::path keep = {};  ///< the response is written here; empty: not kept
};

/// One object: method, family, vertices, unknowns, threads, poisson, tolerance and displacements or quality, seconds by
/// stage and total, peak_bytes, and what the method tells of itself; or failure.
nlohmann::json measure_response(const Skin& skin, const ResponseCase& c, const ChildLimits& limits);

/// What is told of every run, of either kind: its case, its memory, and what came out or why nothing did.
nlohmann::json described(const ChildOutcome& outcome, const std::string& family, Index vertices, const ResponseCase& c);

/// The run of median total time. The runs of one case.
nlohmann::json median_run(std::vector<nlohmann::json> runs);

/// Vendor's name of the processor.
std::string processor_name();

}  // namespace skinbem::bench
