// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/mesh/defect.hpp>

#include <cstdio>

namespace skinbem {
namespace {

/// How a kind of defect is told: "3 <several>, the first <at>, <mend>".
struct Wording {
  const char* name;
  const char* one;      ///< behind the count 1; alone where the count says nothing
  const char* several;  ///< behind other counts; null where the count says nothing
  const char* at;       ///< with # for the elements; null where there is no place
  const char* mend;
};

const Wording& wording(DefectKind kind) {
  static const std::array<Wording, 16> words{{
      {"empty", "no triangles", nullptr, nullptr, "a closed surface is needed"},
      {"index_out_of_range", "triangle with a vertex that does not exist",
       "triangles with a vertex that does not exist", "triangle # with index #", "correct the index"},
      {"not_finite", "vertex with a coordinate that is not finite", "vertices with a coordinate that is not finite",
       "vertex #", "correct or remove it"},
      {"size_out_of_range", "the mesh is a single point or its size cannot be computed with", nullptr, "vertex #",
       "scale it to a size and place between 1e-40 and 1e40"},
      {"duplicate_vertex", "duplicate vertex", "duplicate vertices", "vertex # where vertex # is",
       "merge vertices at equal positions (--weld)"},
      {"degenerate_triangle", "degenerate triangle", "degenerate triangles", "triangle #",
       "remove it or collapse its shortest edge"},
      {"duplicate_triangle", "duplicate triangle", "duplicate triangles", "triangle # with the vertices of triangle #",
       "remove one of the two"},
      {"unreferenced_vertex", "unreferenced vertex", "unreferenced vertices", "vertex #",
       "remove it: no triangle uses it"},
      {"non_manifold_edge", "non-manifold edge", "non-manifold edges", "edge between vertices # and #",
       "leave two triangles at each edge"},
      {"open_edge", "open edge", "open edges", "edge between vertices # and #",
       "close the hole: each edge must lie in two triangles"},
      {"inconsistent_orientation", "triangle facing against its neighbours (inconsistent orientation)",
       "triangles facing against their neighbours (inconsistent orientation)", "triangle #", "swap two of its corners"},
      {"one_sided", "the surface is one-sided: no orientation is consistent", nullptr, "edge between vertices # and #",
       "a body needs an inside and an outside"},
      {"non_manifold_vertex", "non-manifold vertex", "non-manifold vertices", "vertex #",
       "give each fan of triangles a vertex of its own"},
      {"self_intersection", "self-intersection", "self-intersections", "triangles # and #",
       "move the surfaces apart (--force goes on with a warning)"},
      {"inside_out", "surface inside out", "surfaces inside out", "the one of triangle #",
       "reverse the triangles: they must be counter-clockwise seen from outside"},
      {"several_bodies", "body too many", "bodies too many", "the one of triangle #",
       "keep one closed outer surface; cavities in it must face inward"},
  }};
  return words[static_cast<std::size_t>(kind)];
}

/// `pattern` with its # replaced by the elements in turn, then the position.
std::string at(const char* pattern, const DefectPlace& place) {
  std::string result;
  std::size_t used = 0;
  for (const char* c = pattern; *c; ++c) {
    if (*c == '#') {
      result += std::to_string(place.elements[used++]);
    } else {
      result += *c;
    }
  }
  char position[120];
  std::snprintf(position, sizeof position, " at (%.6g, %.6g, %.6g)", place.position.x(), place.position.y(),
                place.position.z());
  return result + position;
}

}  // namespace

std::string name_of(DefectKind kind) { return wording(kind).name; }

std::string message(const Defect& defect) {
  const Wording& words = wording(defect.kind);
  std::string text = words.one;
  if (words.several) {
    text = std::to_string(defect.count) + " " + (defect.count == 1 ? words.one : words.several);
    if (defect.at_least) text = "at least " + text;
  }
  if (words.at && !defect.places.empty()) {
    text += defect.count > 1 && words.several ? ", the first " : ": ";
    text += at(words.at, defect.places.front());
  }
  return text + ", " + words.mend;
}

}  // namespace skinbem
