// SPDX-License-Identifier: BSD-3-Clause
// From a mesh and six landmarks to a moving skin. Argument: the folder of the lower limb (default data/lower_limb).
#include <skinbem/frame/frame_model.hpp>
#include <skinbem/mesh/mesh_io.hpp>
#include <skinbem/response/landmark_table.hpp>
#include <skinbem/response/response_model.hpp>

#include <cstdio>

int main(int argc, char** argv) try {
  const std::filesystem::path folder = argc > 1 ? argv[1] : "data/lower_limb";

  // [readme]
  const auto skin = skinbem::read_mesh(folder / "skin.obj");
  const auto table = skinbem::read_landmarks(folder / "landmarks.csv", skin, 15.0);  // radius 15 mm

  skinbem::ResponseModel model(skin, {.poisson = 0.45, .tolerance = 1e-6});  // assembles and factorises, once
  model.add(table.landmarks);                                                // three columns a landmark

  const skinbem::FrameModel frames(skin.vertices, model.response(), model.landmark_positions());
  skinbem::FrameState leg(frames);
  std::vector<float> positions(3 * skin.vertex_count());
  skinbem::Points moved = skinbem::Points::Zero(6, 3);
  for (int frame = 0; frame < 100; ++frame) {
    moved(4, 2) = 0.1 * frame;  // landmark 5H, on the little toe's side, goes up
    leg.set_landmarks(moved);   // displacements, landmark by landmark
    leg.evaluate(positions);    // all vertices: no allocation, no lock, no exception
  }
  // [readme]

  double largest = 0;
  for (skinbem::Index v = 0; v < skin.vertex_count(); ++v) {
    for (int i = 0; i < 3; ++i) largest = std::max(largest, std::abs(positions[3 * v + i] - skin.vertices(v, i)));
  }
  std::printf("%d vertices follow %d landmarks; the largest displacement is %.1f mm\n", int(skin.vertex_count()),
              int(table.landmarks.size()), largest);
  return largest > 5 && largest < 20 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
