// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/mesh/nesting.hpp>

#include <cmath>

#include <skinbem/mesh/closest_point.hpp>

namespace skinbem {
namespace {

struct Surface {
  std::vector<std::int32_t> triangles;
  Box box;
  double volume = 0;
  Index depth = 0;         // number of surfaces around it
  bool outer_out = false;  // of its outermost surface: faces outward
};

std::vector<Surface> split(const TriangleMesh& mesh, const std::vector<std::int32_t>& component, std::int32_t count) {
  std::vector<Surface> surfaces(static_cast<std::size_t>(count));
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    if (component[t] < 0) continue;
    Surface& surface = surfaces[component[t]];
    surface.triangles.push_back(static_cast<std::int32_t>(t));
    surface.box.extend(box_of_triangle(mesh, t));
  }
  for (Surface& surface : surfaces) {
    const Vec3 origin = surface.box.center();
    for (const std::int32_t t : surface.triangles) {
      surface.volume += area_vector(mesh, t).dot(mesh.corner(t, 0) - origin) / 6;
    }
  }
  return surfaces;
}

TriangleMesh part(const TriangleMesh& mesh, const std::vector<std::int32_t>& triangles) {
  TriangleMesh result;
  result.vertices = mesh.vertices;
  result.triangles.resize(static_cast<Index>(triangles.size()), 3);
  for (std::size_t i = 0; i < triangles.size(); ++i)
    result.triangles.row(static_cast<Index>(i)) = mesh.triangles.row(triangles[i]);
  return result;
}

/// Depth of each, and how the outermost one around it faces.
void nest(const TriangleMesh& mesh, std::vector<Surface>& surfaces) {
  std::vector<std::vector<const Surface*>> around(surfaces.size());
  for (const Surface& outer : surfaces) {
    std::vector<std::size_t> candidates;
    for (std::size_t i = 0; i < surfaces.size(); ++i) {
      if (&surfaces[i] != &outer && outer.box.contains(surfaces[i].box)) candidates.push_back(i);
    }
    if (candidates.empty()) continue;
    const SurfaceQuery query(part(mesh, outer.triangles));
    for (const std::size_t i : candidates) {
      const Vec3 point = mesh.corner(surfaces[i].triangles.front(), 0);
      if (std::abs(query.winding_number(point)) > 0.5) around[i].push_back(&outer);
    }
  }
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    surfaces[i].depth = static_cast<Index>(around[i].size());
    surfaces[i].outer_out = surfaces[i].volume > 0;
  }
  for (std::size_t i = 0; i < surfaces.size(); ++i) {
    for (const Surface* outer : around[i]) {
      if (outer->depth == 0) surfaces[i].outer_out = outer->volume > 0;
    }
  }
}

}  // namespace

Nesting nesting_of_components(const TriangleMesh& mesh, const std::vector<std::int32_t>& component,
                              std::int32_t component_count) {
  std::vector<Surface> surfaces = split(mesh, component, component_count);
  nest(mesh, surfaces);
  Nesting result;
  Index outer_surfaces = 0;
  for (const Surface& surface : surfaces) {
    const std::int32_t first = surface.triangles.front();
    const bool faces_out = surface.volume > 0;
    if (surface.depth == 0) {
      if (!faces_out) result.inside_out.push_back(first);
      if (++outer_surfaces > 1) result.further_bodies.push_back(first);
    } else if (surface.depth == 1 && faces_out != surface.outer_out) {
      ++result.cavities;
    } else {
      result.further_bodies.push_back(first);
    }
  }
  return result;
}

}  // namespace skinbem
