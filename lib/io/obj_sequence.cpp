// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/io/obj_sequence.hpp>

#include <skinbem/io/frame_folder.hpp>
#include <skinbem/mesh/mesh_io.hpp>

namespace skinbem {

void write_obj_sequence(const std::filesystem::path& folder, const SkinAnimation& skin,
                        const std::vector<MovingBone>& bones, const Progress& progress) {
  validate(skin, bones);
  write_frame_folder(folder, "obj", [&](const std::filesystem::path& fresh) {
    for (Index f = 0; f < skin.frame_count(); ++f) {
      report(progress, "writing frames", static_cast<double>(f) / static_cast<double>(skin.frame_count()));
      write_mesh(fresh / frame_file("skin", f, "obj"), {skin_vertices(skin, f), skin.rest.triangles});
      if (!bones.empty()) write_mesh(fresh / frame_file("bones", f, "obj"), bones_mesh(bones, f));
    }
  });
}

}  // namespace skinbem
