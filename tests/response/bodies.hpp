// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Bodies and landmarks for the tests of the response.
#pragma once

#include <string>
#include <vector>

#include <skinbem/response/landmark.hpp>

#include "meshes.hpp"

namespace skinbem::testing_support {

inline std::vector<Landmark> landmarks_on(const std::vector<std::int32_t>& vertices, double radius = 0) {
  std::vector<Landmark> landmarks;
  for (const std::int32_t v : vertices) {
    Landmark landmark;
    landmark.name = std::to_string(v).insert(0, 1, 'L');
    landmark.vertex = v;
    landmark.radius = radius;
    landmarks.push_back(landmark);
  }
  return landmarks;
}

struct Body {
  const char* name;
  TriangleMesh mesh;
  std::vector<std::int32_t> landmarks;
  double poisson;
};

/// Vertex nearest to a point.
inline std::int32_t vertex_at(const TriangleMesh& mesh, const Vec3& x) {
  Index nearest = 0;
  (mesh.vertices.rowwise() - x.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
  return static_cast<std::int32_t>(nearest);
}

inline Body make_body(const char* name, const TriangleMesh& mesh, const std::vector<Vec3>& places, double poisson) {
  Body body{name, mesh, {}, poisson};
  for (const Vec3& place : places) body.landmarks.push_back(vertex_at(mesh, place));
  return body;
}

/// Sharp edges, slender, thin, with a handle, with a cavity, incompressible, auxetic.
inline std::vector<Body> bodies() {
  return {make_body("cube", cube(4), {{0, 0, 0}, {1, 0.5, 0.5}, {0.5, 1, 0}, {0, 0.5, 1}}, 0.3),
          make_body("incompressible cube", cube(3), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, 0.5),
          make_body("auxetic cube", cube(3), {{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}, -0.5),
          make_body("slender box", needle_box(20), {{0, 0, 0}, {10, 0, 0}, {5, 0.5, 0.5}}, 0.45),
          make_body("square ring", square_ring(), {{0, 0, 0}, {3, 0, 0}, {0, 3, 1}}, 0.3),
          make_body("ellipsoid", slender_ellipsoid(2), {{6, 0, 0}, {-6, 0, 0}, {0, 1, 0}, {0, 0, 1}}, 0.49),
          make_body("hollow sphere", hollow_sphere(2), {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {0.5, 0, 0}}, 0.45)};
}

}  // namespace skinbem::testing_support
