// SPDX-License-Identifier: BSD-3-Clause
#include "quadrature_sweep.hpp"

#include <Eigen/Geometry>
#include <boost/multiprecision/eigen.hpp>
#include <boost/multiprecision/float128.hpp>
#include <cstdio>
#include <ostream>
#include <skinbem/base/atomic_file.hpp>
#include <skinbem/kernels/kelvin.hpp>
#include <skinbem/operator/element_integral.hpp>

#include "accuracy_table.hpp"

namespace skinbem {
namespace {

using Eigen::Vector3d;
using Quad = boost::multiprecision::float128;
using QuadVector = Eigen::Matrix<Quad, 3, 1>;
using Corners = std::array<Vector3d, 3>;

struct Shape {
  const char* name;
  Corners corners;  ///< in the plane z = 0, counter-clockwise, the longest edge of length about 1
};

const Shape shapes[] = {
    {"equilateral", {{{0, 0, 0}, {1, 0, 0}, {0.5, 0.8660254037844386, 0}}}},
    {"right", {{{0, 0, 0}, {1, 0, 0}, {0, 1, 0}}}},
    {"obtuse", {{{0, 0, 0}, {1, 0, 0}, {0.4, 0.25, 0}}}},
    {"needle20", {{{0, 0, 0}, {1, 0, 0}, {1, 0.05, 0}}}},
    {"cap200", {{{0, 0, 0}, {1, 0, 0}, {0.5, 0.005, 0}}}},
    {"needle1000", {{{0, 0, 0}, {1, 0, 0}, {1, 0.001, 0}}}},
};

struct Position {
  const char* name;
  Vector3d (*point)(const Corners& v, double distance);
};

const Position positions[] = {
    {"above_interior",
     [](const Corners& v, double d) -> Vector3d { return 0.3 * v[0] + 0.3 * v[1] + 0.4 * v[2] + Vector3d(0, 0, d); }},
    {"above_edge", [](const Corners& v, double d) -> Vector3d { return (v[0] + v[1]) / 2 + Vector3d(0, 0, d); }},
    {"above_vertex", [](const Corners& v, double d) -> Vector3d { return v[2] + Vector3d(0, 0, d); }},
    {"in_plane_outside", [](const Corners& v, double d) -> Vector3d { return (v[0] + v[1]) / 2 - Vector3d(0, d, 0); }},
    {"beyond_vertex",
     [](const Corners& v, double d) -> Vector3d { return v[2] + d * (v[2] - (v[0] + v[1]) / 2).normalized(); }},
    {"aside",
     [](const Corners& v, double d) -> Vector3d { return v[0] + d * Vector3d(-0.6, -0.48, 0.64).normalized(); }},
};

/// Of the distance over the longest edge: 1e-8 to 40, closer together where the rules change.
std::vector<double> distances() {
  std::vector<double> result;
  for (int k = -32; k < -8; ++k) result.push_back(std::pow(10.0, k / 4.0));
  for (int k = -32; k <= 26; ++k) result.push_back(std::pow(10.0, k / 16.0));
  return result;
}

struct Way {
  std::string name;
  double tolerance;
};

std::vector<Way> ways() {
  std::vector<Way> result = {{"closed", 1e-12}};
  for (const char* name : {"auto", "near"})
    for (const double tolerance : {1e-4, 1e-8, 1e-12}) result.push_back({name, tolerance});
  for (const MeasuredRule& m : measured_rules()) result.push_back({gauss_rule_name(m), 1e-12});
  return result;
}

/// The closed form in quadruple precision.
ElementBlocks reference(const QuadratureCase& c) {
  const auto& v = c.vertices;
  const TriangleGeometry<Quad> g(v[0].cast<Quad>(), v[1].cast<Quad>(), v[2].cast<Quad>());
  const Kelvin<Quad> kernel{Quad(c.poisson), Quad(1)};
  const QuadVector x = c.x.cast<Quad>();
  const auto single = single_layer_moments<Quad>(g, x);
  const auto twice = double_layer_moments<Quad>(g, x);
  ElementBlocks blocks;
  for (int a = 0; a < 3; ++a) {
    blocks.U[a] = kernel.single_layer_integral(single[a]).cast<double>();
    blocks.T[a] = kernel.double_layer_integral(twice[a], g.normal).cast<double>();
  }
  return blocks;
}

std::string number(double value) {
  char text[32];
  std::snprintf(text, sizeof text, "%.4g", value);
  return text;
}

/// What the library's error model says of U and T: of a Gauss rule, and of the rounding of the closed form;
/// blank for the others.
std::string model(const std::string& name, const QuadratureCase& c) {
  if (name == "closed") {
    const SourceTriangle triangle(c.vertices[0], c.vertices[1], c.vertices[2]);
    return number(single_layer_rounding(triangle, c.x)) + ',' + number(double_layer_rounding(triangle, c.x));
  }
  for (const MeasuredRule& m : measured_rules()) {
    const double ratio = radius_ratio(c);
    if (name == gauss_rule_name(m) && ratio > 1) return number(m.error(ratio, 1)) + ',' + number(m.error(ratio, 2));
  }
  return ",";
}

void write_case(const QuadratureCase& c, const std::vector<Way>& all_ways, std::ostream& out) {
  for (const Way& way : all_ways) {
    const RuleMeasurement m = measure(*make_element_rule(way.name, c, way.tolerance), c, 4e3);
    out << c.id << ',' << number(c.poisson) << ',' << way.name << ',' << number(way.tolerance) << ','
        << number(m.error_U) << ',' << number(m.error_T) << ',' << m.evaluations << ',' << number(m.ns_U) << ','
        << number(m.ns_T) << ',' << number(radius_ratio(c)) << ',' << model(way.name, c) << '\n';
  }
}

}  // namespace

long sweep_quadrature(const std::filesystem::path& path) {
  const auto all_ways = ways();
  long cases = 0;
  write_file_atomically(path, [&](std::ostream& out) {
    out << "shape,position,distance,nu,rule,tolerance,error_U,error_T,evaluations,ns_U,ns_T,radius_ratio,model_U,"
           "model_T\n";
    for (const Shape& shape : shapes)
      for (const Position& position : positions)
        for (const double distance : distances())
          for (const double nu : {-0.5, 0.3, 0.45}) {
            QuadratureCase c;
            c.id = std::string(shape.name) + ',' + position.name + ',' + number(distance);
            c.poisson = nu;
            c.vertices = shape.corners;
            c.x = position.point(shape.corners, distance * longest_edge(c));
            c.exact = reference(c);
            c.has_T = {true, true, true};
            write_case(c, all_ways, out);
            ++cases;
          }
  });
  return cases * static_cast<long>(all_ways.size());
}

}  // namespace skinbem
