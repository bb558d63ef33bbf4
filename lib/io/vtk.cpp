// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/io/vtk.hpp>

#include <cstdint>
#include <sstream>

#include <skinbem/base/atomic_file.hpp>
#include <skinbem/base/error.hpp>
#include <skinbem/io/frame_folder.hpp>

namespace skinbem {
namespace {

using PointsF = Eigen::Matrix<float, Eigen::Dynamic, 3, Eigen::RowMajor>;

/// The appended section: each array is its length in bytes (UInt64) and then its bytes.
class Appended {
 public:
  /// Adds an array and returns the XML element that refers to it.
  std::string array(const char* type, const char* name, int components, const void* data, std::uint64_t bytes) {
    std::ostringstream element;
    element << "<DataArray type=\"" << type << "\" Name=\"" << name << "\" NumberOfComponents=\"" << components
            << "\" format=\"appended\" offset=\"" << bytes_.size() << "\"/>\n";
    bytes_.append(reinterpret_cast<const char*>(&bytes), sizeof bytes);
    bytes_.append(static_cast<const char*>(data), bytes);
    return element.str();
  }
  const std::string& bytes() const { return bytes_; }

 private:
  std::string bytes_;
};

std::string points_array(Appended& appended, const char* name, const Points& points) {
  const PointsF rows = points.cast<float>();
  require_finite(rows.allFinite(), "a point in single precision");
  return appended.array("Float32", name, 3, rows.data(), sizeof(float) * static_cast<std::uint64_t>(rows.size()));
}

std::string triangle_arrays(Appended& appended, const Triangles& triangles) {
  const std::uint64_t count = static_cast<std::uint64_t>(triangles.rows());
  std::vector<std::int32_t> ends(count);
  for (std::uint64_t t = 0; t < count; ++t) ends[t] = static_cast<std::int32_t>(3 * (t + 1));
  return appended.array("Int32", "connectivity", 1, triangles.data(), 3 * count * sizeof(std::int32_t)) +
         appended.array("Int32", "offsets", 1, ends.data(), count * sizeof(std::int32_t));
}

std::string collection(const SkinAnimation& skin, const std::string& folder, bool with_bones) {
  std::ostringstream out;
  out.precision(17);
  out << "<?xml version=\"1.0\"?>\n<VTKFile type=\"Collection\" version=\"1.0\" byte_order=\"LittleEndian\">\n"
         "<Collection>\n";
  for (Index f = 0; f < skin.frame_count(); ++f) {
    for (int part = 0; part <= (with_bones ? 1 : 0); ++part) {
      out << "<DataSet timestep=\"" << skin.times[static_cast<std::size_t>(f)] << "\" part=\"" << part << "\" file=\""
          << folder << '/' << frame_file(part == 0 ? "skin" : "bones", f, "vtp") << "\"/>\n";
    }
  }
  out << "</Collection>\n</VTKFile>\n";
  return out.str();
}

/// Folder names come from the user and stand in an XML attribute.
std::string xml_escaped(const std::string& text) {
  std::string escaped;
  for (char c : text) {
    if (c == '&')
      escaped += "&amp;";
    else if (c == '<')
      escaped += "&lt;";
    else if (c == '"')
      escaped += "&quot;";
    else
      escaped += c;
  }
  return escaped;
}

}  // namespace

void write_vtp(const std::filesystem::path& path, const TriangleMesh& mesh, const Points& displacement) {
  Appended appended;
  const std::string points = points_array(appended, "points", mesh.vertices);
  const std::string polygons = triangle_arrays(appended, mesh.triangles);
  const std::string data = displacement.rows() > 0 ? points_array(appended, "displacement", displacement) : "";
  write_file_atomically(path, [&](std::ostream& out) {
    out << "<?xml version=\"1.0\"?>\n"
           "<VTKFile type=\"PolyData\" version=\"1.0\" byte_order=\"LittleEndian\" header_type=\"UInt64\">\n"
           "<PolyData>\n<Piece NumberOfPoints=\""
        << mesh.vertex_count() << "\" NumberOfVerts=\"0\" NumberOfLines=\"0\" NumberOfStrips=\"0\" NumberOfPolys=\""
        << mesh.triangle_count() << "\">\n<PointData Vectors=\"displacement\">\n"
        << data << "</PointData>\n<Points>\n"
        << points << "</Points>\n<Polys>\n"
        << polygons << "</Polys>\n</Piece>\n</PolyData>\n<AppendedData encoding=\"raw\">\n_";
    out.write(appended.bytes().data(), static_cast<std::streamsize>(appended.bytes().size()));
    out << "\n</AppendedData>\n</VTKFile>\n";
  });
}

void write_vtk_sequence(const std::filesystem::path& path, const SkinAnimation& skin,
                        const std::vector<MovingBone>& bones, const Progress& progress) {
  validate(skin, bones);
  if (std::filesystem::is_directory(path)) {
    throw Error(ErrorCode::io, path.string() + ": is a directory, name a file");
  }
  std::filesystem::path folder = path;
  folder.replace_extension();
  folder += "_frames";
  write_frame_folder(folder, "vtp", [&](const std::filesystem::path& fresh) {
    for (Index f = 0; f < skin.frame_count(); ++f) {
      report(progress, "writing frames", static_cast<double>(f) / static_cast<double>(skin.frame_count()));
      const Points vertices = skin_vertices(skin, f);
      write_vtp(fresh / frame_file("skin", f, "vtp"), {vertices, skin.rest.triangles}, vertices - skin.rest.vertices);
      if (!bones.empty()) write_vtp(fresh / frame_file("bones", f, "vtp"), bones_mesh(bones, f));
    }
  });
  const std::string text = collection(skin, xml_escaped(folder.filename().string()), !bones.empty());
  write_file_atomically(path, [&](std::ostream& out) { out << text; });
}

}  // namespace skinbem
