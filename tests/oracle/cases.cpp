// SPDX-License-Identifier: BSD-3-Clause
#include <cmath>
#include <cstdint>
#include <numbers>

#include "case_table.hpp"

namespace skinbem::oracle {
namespace {

using Eigen::Vector3d;

/// SplitMix64 (Steele, Lea, Flood, OOPSLA 2014): the same numbers everywhere.
class Random {
 public:
  explicit Random(std::uint64_t seed) : state_(seed) {}
  double uniform() { return static_cast<double>(next() >> 11) * 0x1p-53; }
  double between(double low, double high) { return low + (high - low) * uniform(); }
  template <class List>
  auto one_of(const List& list) {
    return list[next() % list.size()];
  }

 private:
  std::uint64_t next() {
    std::uint64_t z = (state_ += 0x9e3779b97f4a7c15u);
    z = (z ^ (z >> 30)) * 0xbf58476d1ce4e5b9u;
    z = (z ^ (z >> 27)) * 0x94d049bb133111ebu;
    return z ^ (z >> 31);
  }
  std::uint64_t state_;
};

using Corners2 = std::array<Vector3d, 3>;

struct Shape {
  std::string name;
  Corners2 corners;
};

/// Longest edge about 1, in the plane z = 0.
const std::vector<Shape>& shapes() {
  static const std::vector<Shape> list = {
      {"equilateral", {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0.5, std::sqrt(3.0) / 2, 0)}},
      {"right", {Vector3d(0, 0, 0), Vector3d(0.75, 0, 0), Vector3d(0, 0.625, 0)}},
      {"needle100", {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0.995, 0.01, 0)}},
      {"needle1000", {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(1.0, 0.001, 0)}},
      {"cap30", {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0.4, 1.0 / 30, 0)}},
      {"cap300", {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0.55, 1.0 / 300, 0)}},
      {"obtuse", {Vector3d(0, 0, 0), Vector3d(1, 0, 0), Vector3d(0.125, 0.25, 0)}},
  };
  return list;
}

struct Ratio {
  const char* name;
  double value;
};
constexpr std::array<Ratio, 8> ratios = {{{"1", 1},
                                          {"0.3", 0.3},
                                          {"0.1", 0.1},
                                          {"1e-2", 1e-2},
                                          {"1e-3", 1e-3},
                                          {"1e-4", 1e-4},
                                          {"1e-6", 1e-6},
                                          {"1e-8", 1e-8}}};
constexpr std::array<const char*, 3> scales = {"1", "1e-3", "1e3"};
constexpr std::array<double, 6> poisson_ratios = {-0.5, 0.0, 0.3, 0.45, 0.49, 0.5};

/// One case in the plane z = 0 on its way to the table.
class Maker {
 public:
  std::vector<Case> take() { return std::move(cases_); }

  /// Every shape, `count` positions each.
  template <class Place>
  void add_class(const std::string& group, int count, Place&& place) {
    for (const Shape& shape : shapes())
      for (int k = 0; k < count; ++k) add(group, shape, place);
  }

  /// `place(shape, ratio, case)` returns x and sets case.position.
  template <class Place>
  void add(const std::string& group, const Shape& shape, Place&& place) {
    Case c;
    c.id = std::string("e").append(std::to_string(cases_.size() + 1));
    c.group = group;
    c.shape = shape.name;
    const Ratio ratio = random.one_of(ratios);
    c.ratio = ratio.name;
    c.nu = random.one_of(poisson_ratios);
    c.scale = random.one_of(scales);
    c.corners = shape.corners;
    c.x = place(shape.corners, ratio.value, c);
    const double scale = std::strtod(c.scale.c_str(), nullptr);
    for (Vector3d& corner : c.corners) corner *= scale;
    c.x *= scale;
    c.orient = group == "inplane_interior_cpv" || random.uniform() < 0.4 ? "aligned" : "rotated";
    if (c.orient == "rotated") rotate(c, scale);
    cases_.push_back(c);
  }

  Random random{20240611};

 private:
  void rotate(Case& c, double scale) {
    Eigen::Vector4d q(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    const Eigen::Matrix3d R = Eigen::Quaterniond(q).normalized().toRotationMatrix();
    const Vector3d offset = scale * Vector3d(random.between(-2, 2), random.between(-2, 2), random.between(-2, 2));
    const bool at_vertex[] = {c.x == c.corners[0], c.x == c.corners[1], c.x == c.corners[2]};
    for (Vector3d& corner : c.corners) corner = R * corner + offset;
    c.x = R * c.x + offset;
    for (int k = 0; k < 3; ++k)
      if (at_vertex[k]) c.x = c.corners[k];
  }

  std::vector<Case> cases_;
};

Vector3d inside(const Corners2& v, Random& random) {
  double a = random.between(0.05, 0.95), b = random.between(0.05, 0.95);
  if (a + b > 0.95) {
    a = 0.5 * (1 - a);
    b = 0.5 * (1 - b);
  }
  return v[0] + a * (v[1] - v[0]) + b * (v[2] - v[0]);
}

Vector3d outward(const Corners2& v, int edge) {
  const Vector3d along = (v[(edge + 2) % 3] - v[(edge + 1) % 3]).normalized();
  return {along[1], -along[0], 0};
}

}  // namespace

std::vector<Case> make_cases() {
  Maker maker;
  Random& random = maker.random;
  const auto edge = [&](Case& c) {
    const int e = static_cast<int>(3 * random.uniform());
    c.position = std::string("edge").append(std::to_string(e));
    return e;
  };
  const auto corner = [&](Case& c) {
    const int k = static_cast<int>(3 * random.uniform());
    c.position = std::string("v").append(std::to_string(k));
    return k;
  };
  const auto side = [&] { return random.uniform() < 0.5 ? -1.0 : 1.0; };
  const auto on_edge = [&](const Corners2& v, int e) {
    return Vector3d(v[(e + 1) % 3] + random.between(0.01, 0.99) * (v[(e + 2) % 3] - v[(e + 1) % 3]));
  };

  maker.add_class("near_interior", 4, [&](const Corners2& v, double ratio, Case& c) {
    c.position = std::string("interior");
    return Vector3d(inside(v, random) + Vector3d(0, 0, side() * ratio));
  });
  maker.add_class("near_edge", 4, [&](const Corners2& v, double ratio, Case& c) {
    return Vector3d(on_edge(v, edge(c)) + Vector3d(0, 0, side() * ratio));
  });
  maker.add_class("near_vertex", 3, [&](const Corners2& v, double ratio, Case& c) {
    return Vector3d(v[corner(c)] + Vector3d(0, 0, side() * ratio));
  });
  maker.add_class("beside_edge", 3, [&](const Corners2& v, double ratio, Case& c) {
    const int e = edge(c);
    const double angle = random.between(-0.5, 0.5) * std::numbers::pi;
    return Vector3d(on_edge(v, e) + ratio * (std::cos(angle) * outward(v, e) + Vector3d(0, 0, std::sin(angle))));
  });
  maker.add_class("beside_vertex", 3, [&](const Corners2& v, double ratio, Case& c) {
    const Vector3d direction(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    return Vector3d(v[corner(c)] + ratio * direction.normalized());
  });
  maker.add_class("inplane_outside_edge", 2, [&](const Corners2& v, double ratio, Case& c) {
    const int e = edge(c);
    return Vector3d(on_edge(v, e) + ratio * outward(v, e));
  });
  maker.add_class("inplane_collinear", 1, [&](const Corners2& v, double ratio, Case& c) {
    c.position = std::string("beyond_v0");  // edge v0 v1 lies on the x axis
    return Vector3d(v[0] - Vector3d(ratio, 0, 0));
  });
  maker.add_class("at_vertex", 2, [&](const Corners2& v, double, Case& c) {
    c.ratio = std::string("0");
    return v[corner(c)];
  });
  maker.add_class("inplane_interior_cpv", 1, [&](const Corners2& v, double, Case& c) {
    c.ratio = std::string("0");
    c.position = std::string("interior");
    return inside(v, random);
  });
  maker.add_class("far", 1, [&](const Corners2& v, double, Case& c) {
    c.ratio = std::string("4");
    c.position = std::string("random");
    const Vector3d direction(random.between(-1, 1), random.between(-1, 1), random.between(-1, 1));
    return Vector3d(v[0] + random.between(2, 6) * direction.normalized());
  });
  return maker.take();
}

}  // namespace skinbem::oracle
