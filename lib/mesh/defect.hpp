// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What can be wrong with a mesh, and how it is told.
#pragma once

#include <array>
#include <string>
#include <vector>

#include <skinbem/base/types.hpp>

namespace skinbem {

/// In the order of importance: a defect may be the consequence of an earlier one in this list.
enum class DefectKind {
  empty,                     ///< no vertices or no triangles
  index_out_of_range,        ///< a triangle refers to a vertex that does not exist
  not_finite,                ///< a coordinate is NaN or infinite
  size_out_of_range,         ///< too large or too small for double precision, or a single point
  duplicate_vertex,          ///< two vertices at exactly the same position
  degenerate_triangle,       ///< a vertex twice in it, or so thin that its plane is lost in rounding
  duplicate_triangle,        ///< the same three vertices as an earlier triangle, in any order
  unreferenced_vertex,       ///< in no triangle
  non_manifold_edge,         ///< in more than two triangles
  open_edge,                 ///< in one triangle only
  inconsistent_orientation,  ///< a triangle faces against its neighbours
  one_sided,                 ///< no choice of orientations is consistent (a Moebius strip, a Klein bottle)
  non_manifold_vertex,       ///< several fans of triangles meet in it and in no edge
  self_intersection,         ///< two triangles share a point beside their common corners
  inside_out,                ///< the outer surface faces inward
  several_bodies,            ///< more than one body, or a body within a body
};

/// Where: a vertex; an edge as its two vertices; a triangle; two triangles; or the first triangle of a component.
struct DefectPlace {
  std::array<Index, 2> elements{-1, -1};  ///< 0-based; the second is -1 where there is one only
  Vec3 position = Vec3::Zero();           ///< in the middle of it
};

struct Defect {
  DefectKind kind;
  Index count = 0;                  ///< how many there are
  bool at_least = false;            ///< counting was given up there
  std::vector<DefectPlace> places;  ///< the first few
};

/// Identifier for programs: "open_edge" and so on.
std::string name_of(DefectKind kind);

/// One line for people: how many, the first place, the mend. Numbers count from 0.
std::string message(const Defect& defect);

}  // namespace skinbem
