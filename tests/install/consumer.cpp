// SPDX-License-Identifier: BSD-3-Clause
// What a user of the installed library writes: a tetrahedron moved as a whole by three of its corners.
#include <cstdio>
#include <vector>

#include <skinbem/response/response_model.hpp>

int main() {
  skinbem::TriangleMesh mesh;
  mesh.vertices = skinbem::Points{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  mesh.triangles = skinbem::Triangles{{0, 2, 1}, {0, 1, 3}, {0, 3, 2}, {1, 2, 3}};
  skinbem::ResponseModel model(mesh);
  model.add(std::vector<skinbem::Landmark>{
      {.name = "a", .vertex = 0}, {.name = "b", .vertex = 1}, {.name = "c", .vertex = 2}});
  const Eigen::VectorXd skin = model.response() * Eigen::Vector3d(1, 2, 3).replicate(3, 1);
  std::printf("%.12g %.12g %.12g\n", skin[9], skin[10], skin[11]);
  return (skin - Eigen::Vector3d(1, 2, 3).replicate(4, 1)).norm() < 1e-9 ? 0 : 1;
}
