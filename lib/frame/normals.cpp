// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/frame/normals.hpp>

#include <Eigen/Geometry>
#include <cmath>
#include <string>

#include <skinbem/base/error.hpp>

namespace skinbem {
namespace {

void check_triangles(const Triangles& triangles, Index vertex_count) {
  for (Index t = 0; t < triangles.rows(); ++t) {
    if (triangles.row(t).minCoeff() < 0 || triangles.row(t).maxCoeff() >= vertex_count) {
      throw Error(ErrorCode::usage, "normals: triangle " + std::to_string(t) + " names a vertex outside 0 to " +
                                        std::to_string(vertex_count - 1));
    }
  }
}

Mat3 cross_matrix(const Vec3& v) {
  Mat3 m;
  m << 0, -v.z(), v.y(), v.z(), 0, -v.x(), -v.y(), v.x(), 0;
  return m;
}

}  // namespace

VertexNormals::VertexNormals(const Triangles& triangles, Index vertex_count)
    : corners_(triangles.data(), triangles.data() + triangles.size()),
      begin_(static_cast<std::size_t>(vertex_count) + 1, 0),
      around_(corners_.size()),
      area_vectors_(corners_.size()) {
  check_triangles(triangles, vertex_count);
  for (const std::int32_t v : corners_) ++begin_[static_cast<std::size_t>(v) + 1];
  for (std::size_t v = 1; v < begin_.size(); ++v) begin_[v] += begin_[v - 1];
  std::vector<std::uint32_t> next(begin_.begin(), begin_.end() - 1);
  for (std::size_t c = 0; c < corners_.size(); ++c) {
    around_[next[static_cast<std::size_t>(corners_[c])]++] = static_cast<std::uint32_t>(c / 3);
  }
}

bool VertexNormals::evaluate(const VertexSource& positions, const VertexTarget& normals) noexcept {
  const std::size_t vertices = begin_.size() - 1;
  if (!positions.holds(vertices) || !normals.holds(vertices)) return false;
  using Vector = Eigen::Vector3f;
  using Place = Eigen::Map<Vector>;
  using ConstPlace = Eigen::Map<const Vector>;
  for (std::size_t c = 0; c < corners_.size(); c += 3) {
    const auto corner = [&](std::size_t i) {
      return ConstPlace(positions.vertex(static_cast<std::size_t>(corners_[c + i])));
    };
    const Vector a = corner(0);
    Place(area_vectors_.data() + c) = (corner(1) - a).cross(corner(2) - a);
  }
  for (std::size_t v = 0; v < vertices; ++v) {
    Vector sum = Vector::Zero();
    for (std::uint32_t i = begin_[v]; i < begin_[v + 1]; ++i) sum += ConstPlace(area_vectors_.data() + 3 * around_[i]);
    const float length = sum.norm();
    if (length > 0 && std::isfinite(length)) {
      Place(normals.vertex(v)) = sum / length;
    } else {
      Place(normals.vertex(v)) = Vector::Zero();
    }
  }
  return true;
}

LinearNormals linear_normals(const Points& rest, const Triangles& triangles, const Eigen::MatrixXd& response) {
  check_triangles(triangles, rest.rows());
  if (response.rows() != 3 * rest.rows()) {
    throw Error(ErrorCode::usage, "normals: a response of " + std::to_string(response.rows()) +
                                      " rows does not belong to " + std::to_string(rest.rows()) + " vertices");
  }
  LinearNormals normals{Points::Zero(rest.rows(), 3), Eigen::MatrixXd::Zero(response.rows(), response.cols())};
  for (Index t = 0; t < triangles.rows(); ++t) {
    const auto corner = [&](Index c) { return Vec3(rest.row(triangles(t, c))); };
    const auto moved = [&](Index c) { return response.middleRows<3>(3 * triangles(t, c)); };
    const Vec3 ab = corner(1) - corner(0);
    const Vec3 ac = corner(2) - corner(0);
    // d (ab x ac) = ab x d(ac) - ac x d(ab)
    const Eigen::Matrix<double, 3, Eigen::Dynamic> change =
        cross_matrix(ab) * (moved(2) - moved(0)) - cross_matrix(ac) * (moved(1) - moved(0));
    for (Index c = 0; c < 3; ++c) {
      normals.rest.row(triangles(t, c)) += ab.cross(ac).transpose();
      normals.response.middleRows<3>(3 * triangles(t, c)) += change;
    }
  }
  for (Index v = 0; v < rest.rows(); ++v) {
    const double length = normals.rest.row(v).norm();
    if (!(length > 0)) throw Error(ErrorCode::bad_input, "normals: vertex " + std::to_string(v) + " has no normal");
    const Vec3 normal = normals.rest.row(v) / length;
    normals.rest.row(v) = normal;
    // d (s / |s|) = (I - n n^T) ds / |s|
    const Mat3 tangential = (Mat3::Identity() - normal * normal.transpose()) / length;
    normals.response.middleRows<3>(3 * v) = (tangential * normals.response.middleRows<3>(3 * v)).eval();
  }
  return normals;
}

}  // namespace skinbem
