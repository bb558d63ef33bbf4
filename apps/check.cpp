// SPDX-License-Identifier: BSD-3-Clause
#include <fmt/format.h>

#include <skinbem/base/error.hpp>
#include <skinbem/mesh/mesh_io.hpp>
#include <skinbem/mesh/validate.hpp>

#include "commands.hpp"

namespace {

struct CheckOptions {
  std::string mesh;
  bool weld = false;
};

void check(const CheckOptions& options) {
  const skinbem::TriangleMesh mesh = skinbem::read_mesh(options.mesh, {options.weld});
  const skinbem::Inspection found = skinbem::inspect(mesh);
  if (!found.defects.empty()) {
    for (const skinbem::Defect& defect : found.defects) {
      fmt::print("{}: {}\n", skinbem::name_of(defect.kind), skinbem::message(defect));
    }
    std::fflush(stdout);
    skinbem::require_body(mesh, options.mesh);
  }
  fmt::print("{}: a body of {} vertices, {} triangles, volume {:.6g}, size {:.6g}, genus {}, cavities {}\n",
             options.mesh, mesh.vertex_count(), mesh.triangle_count(), skinbem::volume(mesh), skinbem::diagonal(mesh),
             found.topology.genus, found.topology.cavities);
}

}  // namespace

void add_check(CLI::App& program) {
  auto options = std::make_shared<CheckOptions>();
  CLI::App* command = program.add_subcommand("check", "What is wrong with a mesh, with counts and places");
  command->add_option("MESH", options->mesh, "OBJ, OFF, STL or PLY")->required();
  command->add_flag("--weld", options->weld, "Make vertices at equal positions one");
  command->footer("Exit code 3 when no body can be made of the mesh.\nExample: skinbem check skin.obj");
  command->callback([options] { check(*options); });
}
