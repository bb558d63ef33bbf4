// SPDX-License-Identifier: BSD-3-Clause
#include "mesh_reference.hpp"

#include <Eigen/LU>
#include <charconv>
#include <cstdio>
#include <cstring>
#include <skinbem/base/atomic_file.hpp>
#include <skinbem/base/text.hpp>
#include <stdexcept>

#include "../meshes.hpp"

namespace skinbem::oracle {
namespace {

struct Reference {
  std::string name;
  TriangleMesh mesh;
  std::vector<int> landmarks;
};

std::vector<Reference> references() {
  return {{"ellipsoid", testing_support::ellipsoid(1, {1.0, 1.5, 0.75}), {0, 11, 23, 37}},
          {"box", testing_support::box({1.0, 0.625, 0.25}, {2, 2, 1}), {0, 5, 16}}};
}

Vec3 vertex(const TriangleMesh& mesh, Index k) { return mesh.vertices.row(k).transpose().cast<Real>(); }

std::string shortest(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

void write_obj(const std::filesystem::path& path, const TriangleMesh& mesh) {
  write_file_atomically(path, [&](std::ostream& out) {
    for (Index k = 0; k < mesh.vertex_count(); ++k)
      out << "v " << shortest(mesh.vertices(k, 0)) << ' ' << shortest(mesh.vertices(k, 1)) << ' '
          << shortest(mesh.vertices(k, 2)) << '\n';
    for (Index t = 0; t < mesh.triangle_count(); ++t)
      out << "f " << mesh.triangles(t, 0) + 1 << ' ' << mesh.triangles(t, 1) + 1 << ' ' << mesh.triangles(t, 2) + 1
          << '\n';
  });
}

/// Our own files only: `v x y z` and `f a b c` lines.
TriangleMesh read_obj(const std::filesystem::path& path) {
  const TextFile file(path);
  testing_support::MeshMaker maker;
  for (std::string_view line : file.lines()) {
    const auto cells = words(line);
    if (cells.size() != 4) continue;
    if (cells[0] == "v") maker.vertex({*parse_number(cells[1]), *parse_number(cells[2]), *parse_number(cells[3])});
    const auto index = [&](int k) { return static_cast<std::int32_t>(*parse_integer(cells[k])) - 1; };
    if (cells[0] == "f") maker.triangle(index(1), index(2), index(3));
  }
  return maker.mesh();
}

/// NPY 1.0, little-endian float64, C order.
void write_npy(const std::filesystem::path& path, const Matrix& matrix) {
  std::string header = "{'descr': '<f8', 'fortran_order': False, 'shape': (" + std::to_string(matrix.rows()) + ", " +
                       std::to_string(matrix.cols()) + "), }";
  header.append(63 - (header.size() + 10) % 64, ' ').push_back('\n');
  write_file_atomically(path, [&](std::ostream& out) {
    const auto length = static_cast<std::uint16_t>(header.size());
    out.write("\x93NUMPY\x01\x00", 8).write(reinterpret_cast<const char*>(&length), 2) << header;
    for (Index i = 0; i < matrix.rows(); ++i)
      for (Index j = 0; j < matrix.cols(); ++j) {
        const double value = static_cast<double>(matrix(i, j));
        out.write(reinterpret_cast<const char*>(&value), sizeof value);
      }
  });
}

Matrix read_npy(const std::filesystem::path& path, Index rows, Index columns) {
  const std::string bytes = read_file(path);
  const std::size_t count = static_cast<std::size_t>(rows * columns) * sizeof(double);
  if (bytes.size() < count) throw std::runtime_error(path.string() + ": too short");
  Matrix matrix(rows, columns);
  const char* data = bytes.data() + bytes.size() - count;
  for (Index k = 0; k < rows * columns; ++k) {
    double value;
    std::memcpy(&value, data + static_cast<std::size_t>(k) * sizeof value, sizeof value);
    matrix(k / columns, k % columns) = value;
  }
  return matrix;
}

double difference(const Matrix& a, const Matrix& b) {
  return static_cast<double>(Real((a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff()));
}

struct Poisson {
  const char* suffix;
  double nu;
};
constexpr Poisson poisson_ratios[] = {{"nu030", 0.3}, {"nu045", 0.45}};

}  // namespace

Assembled assemble(const TriangleMesh& mesh, const Kelvin<Real>& kernel) {
  const Index n = mesh.vertex_count();
  Assembled result{Matrix::Zero(3 * n, 3 * n), Matrix::Zero(3 * n, 3 * n)};
#pragma omp parallel for schedule(dynamic)
  for (Index k = 0; k < n; ++k) {
    for (Index t = 0; t < mesh.triangle_count(); ++t) {
      const auto corner = [&](int a) { return vertex(mesh, mesh.triangles(t, a)); };
      const Blocks blocks = integrate_element({corner(0), corner(1), corner(2)}, vertex(mesh, k), kernel);
      for (int a = 0; a < 3; ++a) {
        const Index l = mesh.triangles(t, a);
        result.G.block<3, 3>(3 * k, 3 * l) += blocks.U[a];
        if (l != k) result.H.block<3, 3>(3 * k, 3 * l) += *blocks.T[a];
      }
    }
    Mat3 row_sum = Mat3::Zero();
    for (Index l = 0; l < n; ++l)
      if (l != k) row_sum += result.H.block<3, 3>(3 * k, 3 * l);
    result.H.block<3, 3>(3 * k, 3 * k) = -row_sum;
  }
  return result;
}

Matrix response(const Assembled& a, const std::vector<int>& landmarks) {
  const Index n = a.H.rows(), nk = 3 * static_cast<Index>(landmarks.size());
  Matrix system = a.H, known(n, nk);
  for (std::size_t k = 0; k < landmarks.size(); ++k) {
    known.middleCols(3 * static_cast<Index>(k), 3) = -a.H.middleCols(3 * landmarks[k], 3);
    system.middleCols(3 * landmarks[k], 3) = -a.G.middleCols(3 * landmarks[k], 3);
  }
  Matrix R = system.partialPivLu().solve(known);
  for (std::size_t k = 0; k < landmarks.size(); ++k) {
    R.middleRows(3 * landmarks[k], 3).setZero();
    R.block<3, 3>(3 * landmarks[k], 3 * static_cast<Index>(k)).setIdentity();
  }
  return R;
}

void write_mesh_references(const std::filesystem::path& folder) {
  for (const Reference& r : references()) {
    write_obj(folder / (r.name + ".obj"), r.mesh);
    write_file_atomically(folder / (r.name + "_landmarks.csv"), [&](std::ostream& out) {
      out << "name,vertex\n";
      for (std::size_t k = 0; k < r.landmarks.size(); ++k) out << 'L' << k + 1 << ',' << r.landmarks[k] << '\n';
    });
    for (const auto& [suffix, nu] : poisson_ratios) {
      const Assembled a = assemble(r.mesh, {decimal(nu), Real(1)});
      const auto file = [&](const char* letter) { return folder / (r.name + '_' + letter + '_' + suffix + ".npy"); };
      write_npy(file("H"), a.H);
      Matrix G_K(a.G.rows(), 3 * static_cast<Index>(r.landmarks.size()));
      for (std::size_t k = 0; k < r.landmarks.size(); ++k)
        G_K.middleCols(3 * static_cast<Index>(k), 3) = a.G.middleCols(3 * r.landmarks[k], 3);
      write_npy(file("G"), G_K);
      write_npy(file("R"), response(a, r.landmarks));
      std::printf("%s, nu %g: %td vertices\n", r.name.c_str(), nu, r.mesh.vertex_count());
    }
  }
}

void compare_mesh(const std::filesystem::path& prefix) {
  const TriangleMesh mesh = read_obj(prefix.string() + ".obj");
  const Index n = 3 * mesh.vertex_count();
  for (const auto& [suffix, nu] : poisson_ratios) {
    const Assembled a = assemble(mesh, {decimal(nu), Real(1)});
    const auto theirs = [&](const char* letter) {
      return read_npy(prefix.string() + '_' + letter + '_' + suffix + ".npy", n, n);
    };
    std::printf("%s: H %.1e  G %.1e\n", suffix, difference(a.H, theirs("H")), difference(a.G, theirs("G")));
  }
}

}  // namespace skinbem::oracle
