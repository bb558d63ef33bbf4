// SPDX-License-Identifier: BSD-3-Clause
#include "case_table.hpp"

#include <algorithm>
#include <charconv>
#include <cstdint>
#include <cstdio>
#include <map>
#include <skinbem/base/atomic_file.hpp>

#include "../../bench/quadrature_cases.hpp"

namespace skinbem::oracle {
namespace {

struct Row {
  Blocks exact;
  double agree_U, agree_T, condition_U, condition_T;
};

Corners to_real(const std::array<Eigen::Vector3d, 3>& corners) {
  return {corners[0].cast<Real>(), corners[1].cast<Real>(), corners[2].cast<Real>()};
}

/// The largest change over six trials when every component of v - x is multiplied by 1 + d, |d| <= 2^-53.
void measure_conditioning(const Case& c, const Kelvin<Real>& kernel, Row& row) {
  const Corners corners = to_real(c.corners);
  const Vec3 x = c.x.cast<Real>();
  std::uint64_t state = 1;
  const auto factor = [&] {
    state = state * 6364136223846793005u + 1442695040888963407u;
    return Real(1) + Real(static_cast<double>(static_cast<std::int64_t>(state)) * 0x1p-63) * Real(0x1p-53);
  };
  const Blocks unchanged =
      closed_form_element({Vec3(corners[0] - x), Vec3(corners[1] - x), Vec3(corners[2] - x)}, Vec3::Zero(), kernel);
  row.condition_U = row.condition_T = 0;
  for (int trial = 0; trial < 6; ++trial) {
    Corners moved;
    for (int k = 0; k < 3; ++k)
      for (int i = 0; i < 3; ++i) moved[k][i] = (corners[k][i] - x[i]) * factor();
    const Blocks changed = closed_form_element(moved, Vec3::Zero(), kernel);
    row.condition_U = std::max(row.condition_U, static_cast<double>(difference_U(changed, unchanged)));
    row.condition_T = std::max(row.condition_T, static_cast<double>(difference_T(changed, unchanged)));
  }
}

Row integrate(const Case& c) {
  const Kelvin<Real> kernel{decimal(c.nu), Real(1)};
  const Corners corners = to_real(c.corners);
  const Vec3 x = c.x.cast<Real>();
  Row row{};
  row.exact = integrate_element(corners, x, kernel);
  const Blocks closed = closed_form_element(corners, x, kernel);
  row.agree_U = static_cast<double>(difference_U(closed, row.exact));
  row.agree_T = static_cast<double>(difference_T(closed, row.exact));
  measure_conditioning(c, kernel, row);
  return row;
}

/// Shortest decimal that reads back as the same double.
std::string shortest(double value) {
  char text[32];
  return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

std::string rounded(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.1e", value);
  return text;
}

std::string digits_20(const Real& value) { return value.str(20, std::ios_base::scientific); }

void write_header(std::ostream& out) {
  out << "id,class,shape,orient,scale,position,ratio,h_over_L,dist_over_L,nu";
  for (const char* point : {"v0", "v1", "v2", "x"})
    for (char axis : {'x', 'y', 'z'}) out << ',' << point << axis;
  for (char kernel : {'U', 'T'})
    for (int a = 0; a < 3; ++a)
      for (int i = 1; i <= 3; ++i)
        for (int j = 1; j <= 3; ++j) out << ',' << kernel << a << '_' << i << j;
  out << ",agreeU,agreeT,condU,condT\n";
}

void write_block(std::ostream& out, const std::optional<Mat3>& block) {
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) {
      out << ',';
      if (block) out << digits_20((*block)(i, j));
    }
}

void write_row(std::ostream& out, const Case& c, const Row& row) {
  const auto& v = c.corners;
  const double longest = std::max({(v[1] - v[0]).norm(), (v[2] - v[1]).norm(), (v[0] - v[2]).norm()});
  const Eigen::Vector3d normal = (v[1] - v[0]).cross(v[2] - v[0]).normalized();
  out << c.id << ',' << c.group << ',' << c.shape << ',' << c.orient << ',' << c.scale << ',' << c.position << ','
      << c.ratio << ',' << rounded(normal.dot(c.x - v[0]) / longest) << ','
      << rounded(distance_to_triangle(v, c.x) / longest) << ',' << shortest(c.nu);
  for (const Eigen::Vector3d& point : {v[0], v[1], v[2], c.x})
    for (int i = 0; i < 3; ++i) out << ',' << shortest(point[i]);
  for (const Mat3& block : row.exact.U) write_block(out, block);
  for (const auto& block : row.exact.T) write_block(out, block);
  for (double value : {row.agree_U, row.agree_T, row.condition_U, row.condition_T}) out << ',' << rounded(value);
  out << '\n';
}

}  // namespace

void write_case_table(const std::filesystem::path& path) {
  const std::vector<Case> cases = make_cases();
  std::vector<Row> rows(cases.size());
  double worst = 0;
#pragma omp parallel for schedule(dynamic) reduction(max : worst)
  for (std::size_t k = 0; k < cases.size(); ++k) {
    rows[k] = integrate(cases[k]);
    worst = std::max({worst, rows[k].agree_U, rows[k].agree_T});
  }
  write_file_atomically(path, [&](std::ostream& out) {
    write_header(out);
    for (std::size_t k = 0; k < cases.size(); ++k) write_row(out, cases[k], rows[k]);
  });
  std::printf("%zu cases; the two methods differ by at most %.1e\n", cases.size(), worst);
}

void compare_case_table(const std::filesystem::path& path) {
  const std::vector<QuadratureCase> cases = read_quadrature_cases(path);
  std::map<std::string, std::array<double, 2>> worst;
#pragma omp parallel for schedule(dynamic)
  for (std::size_t k = 0; k < cases.size(); ++k) {
    const QuadratureCase& c = cases[k];
    const Blocks ours =
        integrate_element(to_real(c.vertices), c.x.cast<Real>(), Kelvin<Real>{decimal(c.poisson), Real(1)});
    ElementBlocks rounded_ours;
    for (int a = 0; a < 3; ++a) {
      rounded_ours.U[a] = ours.U[a].cast<double>();
      rounded_ours.T[a] = ours.T[a] ? Eigen::Matrix3d(ours.T[a]->cast<double>()) : Eigen::Matrix3d::Zero();
    }
#pragma omp critical
    {
      auto& [U, T] = worst[c.group];
      U = std::max(U, error_of_U(c, rounded_ours));
      T = std::max(T, error_of_T(c, rounded_ours));
    }
  }
  for (const auto& [group, difference] : worst)
    std::printf("%-24s U %.1e  T %.1e\n", group.c_str(), difference[0], difference[1]);
}

}  // namespace skinbem::oracle
