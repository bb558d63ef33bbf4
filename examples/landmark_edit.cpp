// SPDX-License-Identifier: BSD-3-Clause
// Adding, moving and removing landmarks of a body that is factorised once. Argument: the folder of the lower limb.
#include <skinbem/mesh/mesh_io.hpp>
#include <skinbem/response/landmark_table.hpp>
#include <skinbem/response/response_model.hpp>

#include <cstdio>

int main(int argc, char** argv) try {
  const std::filesystem::path folder = argc > 1 ? argv[1] : "data/lower_limb";
  const auto skin = skinbem::read_mesh(folder / "skin.obj");
  auto landmarks = skinbem::read_landmarks(folder / "landmarks.csv", skin, 15.0).landmarks;

  // [docs]
  skinbem::ResponseModel model(skin);  // the expensive part, once
  model.add(landmarks);                // 18 columns

  const skinbem::Landmark calf{.name = "calf", .vertex = 300, .radius = 15};
  model.add(std::vector{calf});  // three columns more
  landmarks[0].vertex = 8;
  model.move(0, landmarks[0]);  // three columns anew
  model.remove(6);              // nothing to solve: a tiny system is made again when R is asked for
  const Eigen::MatrixXd edited = model.response();
  // [docs]

  skinbem::ResponseModel fresh(skin);
  fresh.add(landmarks);
  const double difference = (edited - fresh.response()).cwiseAbs().maxCoeff();
  std::printf("edited: %.0f + %.0f ms for the body, %.0f ms for all landmarks; difference from a fresh model %.1e\n",
              1e3 * model.summary().assemble_seconds, 1e3 * model.summary().factor_seconds,
              1e3 * model.summary().solve_seconds, difference);
  return difference < 1e-6 ? 0 : 1;
} catch (const std::exception& error) {
  std::fprintf(stderr, "%s\n", error.what());
  return 1;
}
