// SPDX-License-Identifier: BSD-3-Clause
// Any place of the skin as a handle: grabbed, pulled and let go within a frame. Argument: the folder of the lower limb.
#include <skinbem/frame/handles.hpp>
#include <skinbem/mesh/mesh_io.hpp>
#include <skinbem/response/landmark_table.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>

int main(int argc, char** argv) try {
  const std::filesystem::path folder = argc > 1 ? argv[1] : "data/lower_limb";
  const auto skin = skinbem::read_mesh(folder / "skin.obj");
  std::vector<std::int32_t> anchors;
  for (const auto& landmark : skinbem::read_landmarks(folder / "landmarks.csv", skin, 0).landmarks) {
    anchors.push_back(landmark.vertex);
  }

  // [docs]
  skinbem::ResponseModel body(skin);
  const skinbem::HandleModel every_vertex(body);    // once: three Green's functions a vertex
  skinbem::Handles handles(every_vertex, anchors);  // one a character; the six landmarks stay where they are
  std::vector<float> positions(3 * skin.vertex_count());
  const skinbem::VertexTarget target{positions};

  bool good = handles.grab(300);                            // the skin stays as it is ...
  good = good && handles.pull(6, skinbem::Vec3(0, 0, 10));  // ... until the handle, the seventh, is pulled
  good = good && handles.evaluate(target);
  // [docs]

  std::vector<skinbem::Landmark> landmarks;
  for (skinbem::Index k = 0; k < handles.count(); ++k) {
    landmarks.push_back({.name = std::to_string(k), .vertex = handles.vertex(k)});
  }
  body.add(landmarks);
  const Eigen::VectorXd expected = 10 * body.response().col(3 * 6 + 2);
  double difference = 0;
  for (skinbem::Index i = 0; i < expected.size(); ++i) {
    difference = std::max(difference, std::abs(double{positions[i]} - skin.vertices.data()[i] - expected[i]));
  }

  // [release]
  good = good && handles.move(6, 200);  // slides to another vertex, which the skin keeps where it is
  good = good && handles.release(6);    // and lets go
  good = good && handles.evaluate(target);
  // [release]
  double left = 0;
  for (skinbem::Index i = 0; i < expected.size(); ++i) {
    left = std::max(left, std::abs(double{positions[i]} - skin.vertices.data()[i]));
  }
  std::printf("%.1f MB of Green's functions; pulled: %.1e mm from R; released: %.1e mm from rest\n",
              1e-6 * static_cast<double>(every_vertex.bytes()), difference, left);
  return good && difference < 1e-3 && left < 1e-3 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
