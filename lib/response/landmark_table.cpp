// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/response/landmark_table.hpp>

#include <algorithm>
#include <array>
#include <set>

#include <skinbem/base/text.hpp>

namespace skinbem {
namespace {

enum Column : std::size_t { name, vertex, x, y, z, radius, bone, bone_x, bone_y, bone_z, column_count };
/// The cells of a row by column; empty where the file has no such column.
using Row = std::array<std::string, column_count>;

constexpr std::array<std::string_view, column_count> titles = {"name",   "vertex", "x",      "y",      "z",
                                                               "radius", "bone",   "bone_x", "bone_y", "bone_z"};
constexpr double agreement = 1e-6;      // of the diagonal: vertex and coordinates name the same place
constexpr double farthest_snap = 0.05;  // of the diagonal: beyond, the coordinates are not of this skin

std::optional<Column> column_titled(std::string_view title) {
  for (const std::string_view skin : {"skin_vertex", "skin_x", "skin_y", "skin_z"}) {
    if (title == skin) title.remove_prefix(std::string_view("skin_").size());
  }
  const auto found = std::find(titles.begin(), titles.end(), title);
  if (found == titles.end()) return std::nullopt;
  return static_cast<Column>(found - titles.begin());
}

/// One row of the file, with the errors that name it.
struct Line {
  const TextFile& file;
  std::size_t number;  // from 1

  [[noreturn]] void fail(const std::string& what) const { file.fail(number, what); }
  std::vector<std::string> fields(std::string_view text) const;
  std::vector<Column> columns(const std::vector<std::string>& header) const;
  Row row(const std::vector<Column>& columns, const std::vector<std::string>& cells) const;
  std::optional<double> value(const Row& row, Column column) const;
  std::optional<Vec3> point(const Row& row, Column first) const;
};

/// Cuts a line at its commas; a field in quotes may hold commas, and "" for a quote.
std::vector<std::string> Line::fields(std::string_view text) const {
  std::vector<std::string> result;
  bool more = true;
  while (more) {
    std::string field;
    text = text.substr(std::min(text.find_first_not_of(" \t"), text.size()));
    if (text.starts_with('"')) {
      std::size_t at = 1;
      for (;; ++at) {
        if (at >= text.size()) fail("a quoted field is not closed, add the missing \"");
        if (text[at] == '"') {
          if (at + 1 == text.size() || text[at + 1] != '"') break;
          ++at;
        }
        field += text[at];
      }
      text.remove_prefix(at + 1);
      const std::size_t comma = std::min(text.find(','), text.size());
      if (!trimmed(text.substr(0, comma)).empty()) fail("text follows a quoted field, put a comma after the quote");
      text.remove_prefix(comma);
    } else {
      const std::size_t comma = std::min(text.find(','), text.size());
      field = trimmed(text.substr(0, comma));
      text.remove_prefix(comma);
    }
    more = !text.empty();
    if (more) text.remove_prefix(1);
    result.push_back(std::move(field));
  }
  return result;
}

std::vector<Column> Line::columns(const std::vector<std::string>& header) const {
  std::vector<Column> result;
  for (const std::string& title : header) {
    const std::optional<Column> column = column_titled(title);
    if (!column) {
      fail("unknown column '" + title +
           "', the columns are name, vertex, x, y, z, radius, bone, bone_x, bone_y, bone_z (also skin_vertex, skin_x, "
           "skin_y, skin_z)");
    }
    if (std::count(result.begin(), result.end(), *column)) fail("column '" + title + "' is given twice, keep one");
    result.push_back(*column);
  }
  const auto has = [&](Column column) { return std::count(result.begin(), result.end(), column) > 0; };
  if (!has(name)) fail("the header has no column 'name', add it");
  if (!has(vertex) && !(has(x) && has(y) && has(z))) {
    fail("the header has neither 'vertex' nor 'x', 'y', 'z', add the one or the others");
  }
  return result;
}

Row Line::row(const std::vector<Column>& columns, const std::vector<std::string>& cells) const {
  if (cells.size() != columns.size()) {
    fail(std::to_string(cells.size()) + " fields, the header has " + std::to_string(columns.size()) +
         ", write one field per column");
  }
  Row row;
  for (std::size_t i = 0; i < columns.size(); ++i) row[columns[i]] = cells[i];
  return row;
}

std::optional<double> Line::value(const Row& row, Column column) const {
  if (row[column].empty()) return std::nullopt;
  const std::optional<double> value = parse_number(row[column]);
  if (!value) fail("'" + row[column] + "' in column '" + std::string(titles[column]) + "' is not a finite number");
  return value;
}

/// The point in columns first, first + 1, first + 2: all three or none.
std::optional<Vec3> Line::point(const Row& row, Column first) const {
  Vec3 point;
  int given = 0;
  for (int i = 0; i < 3; ++i) {
    const std::optional<double> coordinate = value(row, static_cast<Column>(first + i));
    if (coordinate) point(given++) = *coordinate;
  }
  if (given == 0) return std::nullopt;
  if (given < 3)
    fail("only some of " + std::string(titles[first]) + " and its two companions are given, give all three or none");
  return point;
}

std::int32_t nearest_vertex(const TriangleMesh& mesh, const Vec3& point) {
  Index nearest = 0;
  (mesh.vertices.rowwise() - point.transpose()).rowwise().squaredNorm().minCoeff(&nearest);
  return static_cast<std::int32_t>(nearest);
}

std::optional<std::int32_t> vertex_of(const Line& line, const Row& row, const TriangleMesh& mesh) {
  if (row[vertex].empty()) return std::nullopt;
  const std::optional<std::int64_t> index = parse_integer(row[vertex]);
  if (!index) line.fail("vertex '" + row[vertex] + "' is not a whole number");
  if (*index < 0 || *index >= mesh.vertex_count()) {
    line.fail("vertex " + row[vertex] + " is not on the mesh, which has vertices 0 to " +
              std::to_string(mesh.vertex_count() - 1) +
              "; give a vertex of this mesh, or leave it empty and give x, y, z");
  }
  return static_cast<std::int32_t>(*index);
}

/// The landmark's vertex; coordinates win over an index that lies elsewhere.
std::int32_t centre(const Line& line, const Row& row, const TriangleMesh& mesh, std::vector<LandmarkSnap>& snaps) {
  const std::optional<std::int32_t> index = vertex_of(line, row, mesh);
  const std::optional<Vec3> asked = line.point(row, x);
  if (!asked && !index) line.fail("landmark '" + row[name] + "' has neither a vertex nor x, y, z, give one of them");
  if (!asked) return *index;

  const double size = diagonal(mesh);
  const auto distance = [&](std::int32_t v) { return (mesh.vertices.row(v).transpose() - *asked).norm(); };
  if (index && distance(*index) <= agreement * size) return *index;
  const std::int32_t nearest = nearest_vertex(mesh, *asked);
  if (distance(nearest) > farthest_snap * size) {
    line.fail("landmark '" + row[name] + "' is not on the mesh: the nearest vertex is " +
              std::to_string(distance(nearest)) +
              " away, over 5 % of the mesh's diagonal; check the unit and the file");
  }
  if (index || distance(nearest) > agreement * size) {
    snaps.push_back({row[name], *asked, nearest, distance(nearest), index.has_value()});
  }
  return nearest;
}

}  // namespace

LandmarkTable read_landmarks(const std::filesystem::path& path, const TriangleMesh& mesh, double default_radius) {
  const TextFile file(path);
  LandmarkTable table;
  std::vector<Column> columns;
  std::set<std::string> names;
  for (std::size_t number = 1; number <= file.lines().size(); ++number) {
    const std::string_view text = trimmed(file.lines()[number - 1]);
    if (text.empty() || text.front() == '#') continue;
    const Line line{file, number};
    const std::vector<std::string> cells = line.fields(text);
    if (columns.empty()) {
      columns = line.columns(cells);
      continue;
    }
    const Row row = line.row(columns, cells);
    if (row[name].empty()) line.fail("the landmark has no name, give it one");
    if (!names.insert(row[name]).second) line.fail("landmark '" + row[name] + "' is given twice, rename or remove one");
    Landmark landmark;
    landmark.name = row[name];
    landmark.vertex = centre(line, row, mesh, table.snaps);
    landmark.radius = line.value(row, radius).value_or(default_radius);
    if (landmark.radius < 0) line.fail("radius " + row[radius] + " is negative, give 0 for a point or a length");
    landmark.bone = row[bone];
    landmark.bone_point = line.point(row, bone_x);
    table.landmarks.push_back(std::move(landmark));
  }
  if (columns.empty()) file.fail(0, "is empty, it needs a header row such as name,vertex and a row per landmark");
  if (table.landmarks.empty()) file.fail(0, "holds no landmark, add a row per landmark below the header");
  return table;
}

}  // namespace skinbem
