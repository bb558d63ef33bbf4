// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// The least that is needed to read the shared reference data, independent of the library's own readers.
#pragma once

#include <cstring>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <vector>

#include <skinbem/mesh/triangle_mesh.hpp>

namespace skinbem::testing_support {

/// Vertices and triangles of a well-formed OBJ file.
inline TriangleMesh read_reference_obj(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<double> points;
  std::vector<std::int32_t> corners;
  for (std::string line; std::getline(file, line);) {
    std::istringstream words(line);
    std::string kind, word;
    words >> kind;
    while (words >> word) {
      if (kind == "v") points.push_back(std::stod(word));
      if (kind == "f") corners.push_back(std::stoi(word) - 1);
    }
  }
  TriangleMesh mesh;
  mesh.vertices = Eigen::Map<const Points>(points.data(), static_cast<Index>(points.size()) / 3, 3);
  mesh.triangles = Eigen::Map<const Triangles>(corners.data(), static_cast<Index>(corners.size()) / 3, 3);
  return mesh;
}

/// A column of a CSV file with a header row, as text.
inline std::vector<std::string> read_reference_column(const std::filesystem::path& path, const std::string& name) {
  std::ifstream file(path);
  std::vector<std::string> values;
  std::ptrdiff_t column = -1;
  for (std::string line; std::getline(file, line);) {
    std::istringstream row(line);
    std::vector<std::string> cells;
    for (std::string cell; std::getline(row, cell, ',');) cells.push_back(cell);
    if (column < 0) {
      column = std::find(cells.begin(), cells.end(), name) - cells.begin();
    } else {
      values.push_back(cells.at(static_cast<std::size_t>(column)));
    }
  }
  return values;
}

/// A CSV file of numbers without a header.
inline Eigen::MatrixXd read_reference_csv(const std::filesystem::path& path) {
  std::ifstream file(path);
  std::vector<double> values;
  Index rows = 0;
  for (std::string line; std::getline(file, line); ++rows) {
    std::istringstream row(line);
    for (std::string cell; std::getline(row, cell, ',');) values.push_back(std::stod(cell));
  }
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(values.data(), rows, static_cast<Index>(values.size()) / rows);
}

/// A little-endian float64 NumPy matrix in C order, format 1.0.
inline Eigen::MatrixXd read_reference_npy(const std::filesystem::path& path) {
  std::ifstream file(path, std::ios::binary);
  const std::string bytes((std::istreambuf_iterator<char>(file)), std::istreambuf_iterator<char>());
  const std::size_t header = 10 + static_cast<unsigned char>(bytes.at(8)) + 256u * static_cast<unsigned char>(bytes[9]);
  const char* shape = std::strchr(bytes.c_str() + bytes.find("'shape'", 10), '(') + 1;
  char* next = nullptr;
  const Index rows = std::strtol(shape, &next, 10);
  const Index columns = std::strtol(next + 1, nullptr, 10);
  Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> matrix(rows, columns);
  std::memcpy(matrix.data(), bytes.data() + header, sizeof(double) * static_cast<std::size_t>(matrix.size()));
  return matrix;
}

}  // namespace skinbem::testing_support
