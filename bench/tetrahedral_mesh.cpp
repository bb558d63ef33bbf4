// SPDX-License-Identifier: BSD-3-Clause
#include "tetrahedral_mesh.hpp"

#define TETLIBRARY
#include <tetgen.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <skinbem/base/error.hpp>

namespace skinbem::bench {
namespace {

/// The skin as TetGen takes it; TetGen's object frees the arrays.
void describe(const TriangleMesh& skin, tetgenio& in) {
  in.numberofpoints = static_cast<int>(skin.vertex_count());
  in.pointlist = new double[static_cast<std::size_t>(skin.vertices.size())];
  std::copy_n(skin.vertices.data(), skin.vertices.size(), in.pointlist);
  in.numberoffacets = static_cast<int>(skin.triangle_count());
  in.facetlist = new tetgenio::facet[static_cast<std::size_t>(in.numberoffacets)];
  for (int t = 0; t < in.numberoffacets; ++t) {
    tetgenio::facet& facet = in.facetlist[t];
    tetgenio::init(&facet);
    facet.numberofpolygons = 1;
    facet.polygonlist = new tetgenio::polygon[1];
    tetgenio::init(facet.polygonlist);
    facet.polygonlist->numberofvertices = 3;
    facet.polygonlist->vertexlist = new int[3];
    std::copy_n(skin.triangles.row(t).data(), 3, facet.polygonlist->vertexlist);
  }
}

void run(const std::string& switches, tetgenio& in, tetgenio& out) try {
  tetgenbehavior behavior;
  if (!behavior.parse_commandline(std::string(switches).data())) {
    throw Error(ErrorCode::usage, "TetGen does not know the switches " + switches);
  }
  tetrahedralize(&behavior, &in, &out);
} catch (int code) {
  throw Error(ErrorCode::bad_input, "TetGen cannot fill the body (its error " + std::to_string(code) + ")");
}

/// TetGen's switches, with the volume after `a` in the unit of the mesh.
std::string switches_for(const TriangleMesh& skin, const std::string& quality) {
  const std::size_t a = quality.find('a');
  if (a == std::string::npos) return "pYQ" + quality;
  const double cubes = std::stod(quality.substr(a + 1));
  const double edge = mean_edge_length(skin, neighbours_of_vertices(skin));
  return "pYQ" + quality.substr(0, a + 1) + std::to_string(cubes * std::pow(edge, 3));
}

bool positive(const TetrahedralMesh& mesh, Index e) {
  const auto corner = [&](int a) { return Vec3(mesh.nodes.row(mesh.tetrahedra(e, a))); };
  return (corner(1) - corner(0)).cross(corner(2) - corner(0)).dot(corner(3) - corner(0)) > 0;
}

}  // namespace

TetrahedralMesh fill_with_tetrahedra(const TriangleMesh& skin, const std::string& quality) {
  tetgenio in, out;
  describe(skin, in);
  run(switches_for(skin, quality), in, out);
  TetrahedralMesh mesh;
  mesh.nodes = Eigen::Map<const Points>(out.pointlist, out.numberofpoints, 3);
  mesh.tetrahedra = Eigen::Map<const Tetrahedra>(out.tetrahedronlist, out.numberoftetrahedra, 4);
  for (Index e = 0; e < mesh.tetrahedra.rows(); ++e) {
    if (!positive(mesh, e)) std::swap(mesh.tetrahedra(e, 0), mesh.tetrahedra(e, 1));
  }
  if (mesh.nodes.rows() < skin.vertex_count() || mesh.nodes.topRows(skin.vertex_count()) != skin.vertices) {
    throw Error(ErrorCode::numerical, "TetGen did not keep the vertices of the skin");
  }
  return mesh;
}

IndexLists tetrahedra_around_nodes(const TetrahedralMesh& mesh) {
  std::vector<std::int32_t> offsets(static_cast<std::size_t>(mesh.nodes.rows()) + 1, 0);
  const auto corners = mesh.tetrahedra.reshaped<Eigen::RowMajor>();
  for (const std::int32_t node : corners) ++offsets[static_cast<std::size_t>(node) + 1];
  for (std::size_t i = 1; i < offsets.size(); ++i) offsets[i] += offsets[i - 1];
  std::vector<std::int32_t> items(static_cast<std::size_t>(corners.size())), next(offsets.begin(), offsets.end() - 1);
  for (Index c = 0; c < corners.size(); ++c) {
    items[static_cast<std::size_t>(next[static_cast<std::size_t>(corners[c])]++)] = static_cast<std::int32_t>(c / 4);
  }
  return {std::move(offsets), std::move(items)};
}

}  // namespace skinbem::bench
