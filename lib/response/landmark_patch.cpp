// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/response/landmark_patch.hpp>

#include <cmath>

#include <skinbem/base/error.hpp>

namespace skinbem {

Vec3 LandmarkPatch::measure(const Eigen::Ref<const Points>& field) const {
  Vec3 sum = Vec3::Zero();
  for (const VertexWeight& w : measurement) sum += w.value * field.row(w.vertex).transpose();
  return sum;
}

LandmarkPatch make_patch(const TriangleMesh& mesh, const IndexLists& neighbours, const Eigen::VectorXd& areas,
                         const Landmark& landmark) {
  if (landmark.vertex < 0 || landmark.vertex >= mesh.vertex_count()) {
    throw Error(ErrorCode::bad_input, "landmark " + landmark.name + ": vertex " + std::to_string(landmark.vertex) +
                                          " is not on the mesh, which has " + std::to_string(mesh.vertex_count()) +
                                          " vertices (counted from 0)");
  }
  if (!(landmark.radius >= 0) || !std::isfinite(landmark.radius)) {
    throw Error(ErrorCode::usage, "landmark " + landmark.name + ": the radius must be zero or positive");
  }
  // grow the patch from its centre, along edges, as long as phi is positive
  LandmarkPatch patch;
  std::vector<std::int32_t> reached = {landmark.vertex};
  std::vector<bool> seen(static_cast<std::size_t>(mesh.vertex_count()), false);
  seen[landmark.vertex] = true;
  const auto centre = mesh.vertices.row(landmark.vertex);
  double sum = 0;
  for (std::size_t next = 0; next < reached.size(); ++next) {
    const std::int32_t v = reached[next];
    const double s = v == landmark.vertex ? 0 : (mesh.vertices.row(v) - centre).norm() / landmark.radius;
    const double phi = (1 - s * s) * (1 - s * s);
    patch.traction.push_back({v, phi});
    patch.measurement.push_back({v, phi * areas[v]});
    sum += phi * areas[v];
    for (const std::int32_t neighbour : neighbours[v]) {
      if (!seen[neighbour] && (mesh.vertices.row(neighbour) - centre).norm() < landmark.radius) {
        seen[neighbour] = true;
        reached.push_back(neighbour);
      }
    }
  }
  for (VertexWeight& w : patch.measurement) w.value /= sum;
  return patch;
}

}  // namespace skinbem
