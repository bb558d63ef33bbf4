// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Whether a mesh bounds a body, and if not, what is wrong with it and where.
///
/// A body is one closed, connected outer surface of any genus that faces outward, with any number of cavities: closed
/// surfaces inside it that face inward. Every edge lies in exactly two triangles that run through it in opposite
/// directions, the triangles around a vertex form one fan, and no two triangles share a point beside their common
/// corners.
#pragma once

#include <string>
#include <vector>

#include <skinbem/mesh/defect.hpp>
#include <skinbem/mesh/triangle_mesh.hpp>

namespace skinbem {

/// Of a body.
struct BodyTopology {
  Index components = 0;  ///< closed surfaces: 1 + cavities
  Index cavities = 0;    ///< each adds a null vector at Poisson's ratio 1/2: ill conditioned near it
  Index genus = 0;       ///< of all surfaces together
};

struct Inspection {
  std::vector<Defect> defects;  ///< in the order of DefectKind; empty for a body
  BodyTopology topology;        ///< all 0 unless the defects are none but self-intersections
};

/// All that is wrong with the mesh. What cannot be judged because of a graver defect (no volume without a closed
/// surface, nothing at all with indices out of range) is left out. Never throws on account of the mesh.
/// O(T log T) time; measured 0.3 s for 100,000 triangles (one core of a Zen 4 server).
Inspection inspect(const TriangleMesh& mesh);
/// The defects of inspect().
std::vector<Defect> find_defects(const TriangleMesh& mesh);

struct BodyOptions {
  bool force = false;  ///< self-intersections are warnings
};

struct Body {
  BodyTopology topology;
  std::vector<Defect> warnings;  ///< self-intersections that were let through
};

/// Throws Error(bad_input), "source: defect, place, mend" in one line, for the gravest defect and says how many others
/// there are. `source` is the name of the file, or what the mesh is.
Body require_body(const TriangleMesh& mesh, const std::string& source, const BodyOptions& options = {});

}  // namespace skinbem
