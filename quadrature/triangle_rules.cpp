// SPDX-License-Identifier: BSD-3-Clause
#include <array>
#include <mutex>
#include <skinbem/quadrature/duffy.hpp>
#include <skinbem/quadrature/triangle_rules.hpp>
#include <skinbem/quadrature/triangle_rules_table.hpp>
#include <stdexcept>
#include <string>

namespace skinbem {
namespace {

/// Fills a rule orbit by orbit: an orbit is a point with all its images under the permutations of the corners.
class OrbitWriter {
 public:
  OrbitWriter(int degree, int points) {
    rule_.degree = degree;
    rule_.barycentric.resize(3, points);
    rule_.weights.resize(points);
  }

  void centroid(double weight) { put(1.0 / 3.0, 1.0 / 3.0, 1.0 / 3.0, weight); }

  void orbit_of_3(double a, double weight) {
    const double c = 1.0 - 2.0 * a;
    put(a, a, c, weight);
    put(a, c, a, weight);
    put(c, a, a, weight);
  }

  void orbit_of_6(double a, double b, double weight) {
    const double c = 1.0 - a - b;
    put(a, b, c, weight);
    put(b, c, a, weight);
    put(c, a, b, weight);
    put(b, a, c, weight);
    put(a, c, b, weight);
    put(c, b, a, weight);
  }

  TriangleRule take() { return std::move(rule_); }

 private:
  void put(double a, double b, double c, double weight) {
    rule_.barycentric.col(count_) << a, b, c;
    rule_.weights[count_++] = weight;
  }

  TriangleRule rule_;
  Eigen::Index count_ = 0;
};

TriangleRule expand(const detail::TriangleOrbits& orbits) {
  OrbitWriter writer(orbits.degree, orbits.centroid + 3 * orbits.of_3 + 6 * orbits.of_6);
  const double* p = orbits.parameters.data();
  if (orbits.centroid == 1) writer.centroid(*p++);
  for (int k = 0; k < orbits.of_3; ++k, p += 2) writer.orbit_of_3(p[0], p[1]);
  for (int k = 0; k < orbits.of_6; ++k, p += 3) writer.orbit_of_6(p[0], p[1], p[2]);
  return writer.take();
}

const detail::TriangleOrbits& orbits_for(int degree) {
  for (const auto& orbits : detail::triangle_orbits)
    if (orbits.degree >= degree) return orbits;
  throw std::logic_error("triangle rules: the table ends before max_symmetric_degree");
}

}  // namespace

const TriangleRule& symmetric_triangle_rule(int degree) {
  struct Slot {
    std::once_flag once;
    TriangleRule rule;
  };
  static std::array<Slot, max_symmetric_degree> slots;
  if (degree < 1 || degree > max_symmetric_degree)
    throw std::invalid_argument("symmetric triangle rules have degree 1 to " + std::to_string(max_symmetric_degree) +
                                ", asked for " + std::to_string(degree));
  Slot& slot = slots[degree - 1];
  std::call_once(slot.once, [&] { slot.rule = expand(orbits_for(degree)); });
  return slot.rule;
}

TriangleRule collapsed_triangle_rule(int n) {
  TriangleRule rule;
  rule.degree = 2 * n - 2;
  rule.barycentric.resize(3, n * n);
  rule.weights.resize(n * n);
  Eigen::Index q = 0;
  for_each_duffy_point(0, n, n, [&](const Eigen::Vector3d& barycentric, double weight) {
    rule.barycentric.col(q) = barycentric;
    rule.weights[q++] = weight;
  });
  return rule;
}

}  // namespace skinbem
