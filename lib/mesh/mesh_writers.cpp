// SPDX-License-Identifier: BSD-3-Clause
#include <Eigen/Geometry>
#include <charconv>
#include <limits>

#include <skinbem/base/error.hpp>
#include <skinbem/mesh/mesh_formats.hpp>

namespace skinbem {
namespace {

/// Text for a stream, put together in memory: the numbers in the fewest decimals that read back the same.
class TextOut {
 public:
  explicit TextOut(std::ostream& out) : out_(out) {}
  ~TextOut() { out_.write(text_.data(), static_cast<std::streamsize>(text_.size())); }
  TextOut(const TextOut&) = delete;
  TextOut& operator=(const TextOut&) = delete;

  TextOut& operator<<(const char* literal) {
    text_ += literal;
    return *this;
  }
  template <class Number>
  requires std::is_arithmetic_v<Number> TextOut& operator<<(Number value) {
    char buffer[32];
    text_.append(buffer, std::to_chars(buffer, buffer + sizeof buffer, value).ptr);
    return *this;
  }

 private:
  std::ostream& out_;
  std::string text_;
};

template <class Value>
void put(std::ostream& out, const Value& value) {
  out.write(reinterpret_cast<const char*>(&value), sizeof value);
}

}  // namespace

void write_obj(std::ostream& out, const TriangleMesh& mesh) {
  TextOut text(out);
  for (const auto& v : mesh.vertices.rowwise()) text << "v " << v(0) << " " << v(1) << " " << v(2) << "\n";
  for (const auto& t : mesh.triangles.rowwise()) {
    text << "f " << t(0) + 1 << " " << t(1) + 1 << " " << t(2) + 1 << "\n";
  }
}

void write_off(std::ostream& out, const TriangleMesh& mesh) {
  TextOut text(out);
  text << "OFF\n" << mesh.vertex_count() << " " << mesh.triangle_count() << " 0\n";
  for (const auto& v : mesh.vertices.rowwise()) text << v(0) << " " << v(1) << " " << v(2) << "\n";
  for (const auto& t : mesh.triangles.rowwise()) text << "3 " << t(0) << " " << t(1) << " " << t(2) << "\n";
}

void write_stl(std::ostream& out, const TriangleMesh& mesh) {
  if (mesh.vertices.size() > 0 && mesh.vertices.cwiseAbs().maxCoeff() > std::numeric_limits<float>::max()) {
    throw Error(ErrorCode::bad_input, "a coordinate does not fit into the floats of STL, write PLY, OFF or OBJ");
  }
  char header[80] = "binary STL, skinbem";  // must not begin with "solid"
  out.write(header, sizeof header);
  put(out, static_cast<std::uint32_t>(mesh.triangle_count()));
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    put(out, Eigen::Vector3f(area_vector(mesh, t).stableNormalized().cast<float>()));
    for (int c = 0; c < 3; ++c) put(out, Eigen::Vector3f(mesh.corner(t, c).cast<float>()));
    put(out, std::uint16_t{0});
  }
}

void write_ply(std::ostream& out, const TriangleMesh& mesh) {
  out << "ply\nformat binary_little_endian 1.0\nelement vertex " << mesh.vertex_count()
      << "\nproperty double x\nproperty double y\nproperty double z\nelement face " << mesh.triangle_count()
      << "\nproperty list uchar int vertex_indices\nend_header\n";
  out.write(reinterpret_cast<const char*>(mesh.vertices.data()),
            static_cast<std::streamsize>(sizeof(double)) * mesh.vertices.size());
  for (Index t = 0; t < mesh.triangle_count(); ++t) {
    put(out, std::uint8_t{3});
    for (int c = 0; c < 3; ++c) put(out, mesh.triangles(t, c));
  }
}

}  // namespace skinbem
