// SPDX-License-Identifier: BSD-3-Clause
#include "element_oracle.hpp"

#include <algorithm>
#include <skinbem/quadrature/closed_form.hpp>
#include <skinbem/quadrature/gauss_legendre.hpp>

namespace skinbem::oracle {
namespace {

Vec3 unit_normal(const Corners& v) { return (v[1] - v[0]).cross(v[2] - v[0]).normalized(); }

const GaussRule<Real>& gauss_18() {
  static const GaussRule<Real> rule = make_gauss_legendre<Real>(18);
  return rule;
}

void set_zero(Blocks& blocks) {
  blocks.U.fill(Mat3::Zero());
  blocks.T.fill(Mat3(Mat3::Zero()));
}

// ------------------------------------------------------------------------------------------------- recursive halving

/// The integration of one triangle by parts.
class Halving {
 public:
  Halving(const Corners& corners, const Vec3& x, const Kelvin<Real>& kernel, Blocks& sum)
      : x_(x), normal_(unit_normal(corners)), kernel_(kernel), sum_(sum) {
    add(corners, Mat3::Identity());
  }

 private:
  /// `hats`: column k holds the three hats of the whole triangle at corner k of the part.
  void add(const Corners& v, const Mat3& hats) {
    std::array<Eigen::Vector3d, 3> seen;  // from x, so that nothing is lost in double
    for (int k = 0; k < 3; ++k) seen[k] = Vec3(v[k] - x_).cast<double>();
    int longest = 0;
    double diameter = 0;
    for (int e = 0; e < 3; ++e) {
      const double length = (seen[(e + 2) % 3] - seen[(e + 1) % 3]).norm();
      if (length > diameter) {
        diameter = length;
        longest = e;
      }
    }
    if (distance_to_triangle(seen, Eigen::Vector3d::Zero()) >= diameter) return add_gauss(v, hats);
    const int i = (longest + 1) % 3, j = (longest + 2) % 3;
    const Vec3 middle = (v[i] + v[j]) / Real(2);
    const Vec3 middle_hats = (hats.col(i) + hats.col(j)) / Real(2);
    for (int moved : {i, j}) {
      Corners part = v;
      Mat3 part_hats = hats;
      part[moved] = middle;
      part_hats.col(moved) = middle_hats;
      add(part, part_hats);
    }
  }

  void add_gauss(const Corners& v, const Mat3& hats) {
    const auto& [nodes, weights] = gauss_18();
    const Real twice_area = (v[1] - v[0]).cross(v[2] - v[0]).norm();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      for (std::size_t j = 0; j < nodes.size(); ++j) {
        const Vec3 local(Real(1) - nodes[i], nodes[i] * (Real(1) - nodes[j]), nodes[i] * nodes[j]);
        const Vec3 r = local[0] * (v[0] - x_) + local[1] * (v[1] - x_) + local[2] * (v[2] - x_);
        const Vec3 N = hats * local * (twice_area * nodes[i] * weights[i] * weights[j]);
        const Mat3 U = kernel_.single_layer(r), T = kernel_.double_layer(r, normal_);
        for (int a = 0; a < 3; ++a) {
          sum_.U[a] += N[a] * U;
          *sum_.T[a] += N[a] * T;
        }
      }
    }
  }

  Vec3 x_, normal_;
  const Kelvin<Real>& kernel_;
  Blocks& sum_;
};

// --------------------------------------------------------------------------------------------- polar coordinates, in
// plane

/// The integration about a point x of the triangle's own plane, in it.
class Polar {
 public:
  Polar(const Corners& corners, const Vec3& x, const Kelvin<Real>& kernel, Blocks& sum)
      : v_(corners), x_(x), normal_(unit_normal(corners)), kernel_(kernel), sum_(sum) {
    const Real twice_area = (v_[1] - v_[0]).cross(v_[2] - v_[0]).norm();
    for (int e = 0; e < 3; ++e) {
      const Vec3 edge = v_[(e + 2) % 3] - v_[(e + 1) % 3];
      gradients_.col(e) = normal_.cross(edge) / twice_area;
      hats_[e] = gradients_.col(e).dot(x_ - v_[(e + 1) % 3]);
      if (v_[e] == x_) sum_.T[e].reset();
    }
    for (int e = 0; e < 3; ++e)
      if (v_[(e + 1) % 3] != x_ && v_[(e + 2) % 3] != x_) add_edge(e);
  }

 private:
  /// The part of the triangle between x and edge e, in arc length s from the foot of x: dtheta = d ds / R^2.
  void add_edge(int e) {
    const Vec3 first = v_[(e + 1) % 3] - x_, second = v_[(e + 2) % 3] - x_;
    const Vec3 along = (second - first).normalized();
    const Vec3 foot = first - along.dot(first) * along;
    add_piece(foot, along, along.dot(first), along.dot(second));
  }

  /// Halves [begin, end] until it is no longer than half its distance from x.
  void add_piece(const Vec3& foot, const Vec3& along, const Real& begin, const Real& end) {
    const Real d = foot.norm();
    const Real beside = begin > 0 ? begin : end < 0 ? Real(-end) : Real(0);
    if (Real(2) * (end - begin) > sqrt(d * d + beside * beside)) {
      const Real middle = (begin + end) / Real(2);
      add_piece(foot, along, begin, middle);
      add_piece(foot, along, middle, end);
      return;
    }
    const auto& [nodes, weights] = gauss_18();
    for (std::size_t i = 0; i < nodes.size(); ++i) {
      const Real s = begin + (end - begin) * nodes[i];
      const Vec3 r = foot + s * along;
      const Real R = r.norm();
      add_ray(Vec3(r / R), R, d * (end - begin) * weights[i] / (R * R));
    }
  }

  /// int_0^R K(rho e) (N + g rho) rho drho with U(rho e) = U(e) / rho, T(rho e) = T(e) / rho^2.
  void add_ray(const Vec3& e, const Real& R, const Real& dtheta) {
    const Mat3 U = kernel_.single_layer(e), T = kernel_.double_layer(e, normal_);
    for (int a = 0; a < 3; ++a) {
      const Real slope = gradients_.col(a).dot(e);
      sum_.U[a] += dtheta * (hats_[a] * R + slope * R * R / Real(2)) * U;
      const Real logarithm = at_corner() ? Real(0) : hats_[a] * log(R);
      if (sum_.T[a]) *sum_.T[a] += dtheta * (logarithm + slope * R) * T;
    }
  }

  bool at_corner() const { return x_ == v_[0] || x_ == v_[1] || x_ == v_[2]; }

  Corners v_;
  Vec3 x_, normal_, hats_;
  Mat3 gradients_;
  const Kelvin<Real>& kernel_;
  Blocks& sum_;
};

bool in_closed_triangle(const Corners& v, const Vec3& x) {
  const Vec3 n = unit_normal(v);
  for (const Vec3& corner : v)
    if (corner == x) return true;
  if (n.dot(x - v[0]) != 0) return false;
  for (int e = 0; e < 3; ++e)
    if (!((v[(e + 2) % 3] - v[(e + 1) % 3]).cross(x - v[(e + 1) % 3]).dot(n) > 0)) return false;
  return true;
}

Real relative_difference(const Mat3& a, const Mat3& exact) {
  const Real scale = exact.cwiseAbs().maxCoeff(), change = (a - exact).cwiseAbs().maxCoeff();
  return scale > 0 ? Real(change / scale) : change;
}

}  // namespace

Blocks integrate_element(const Corners& corners, const Vec3& x, const Kelvin<Real>& kernel) {
  Blocks sum;
  set_zero(sum);
  if (in_closed_triangle(corners, x)) {
    Polar(corners, x, kernel, sum);
  } else {
    Halving(corners, x, kernel, sum);
  }
  for (auto& T : sum.T)  // in the plane at nu = 1/2 it vanishes; T has no unit
    if (T && T->cwiseAbs().maxCoeff() < Real(1e-28)) T->setZero();
  return sum;
}

Blocks closed_form_element(const Corners& corners, const Vec3& x, const Kelvin<Real>& kernel) {
  const TriangleGeometry<Real> geometry(corners[0], corners[1], corners[2]);
  const auto U = single_layer_moments(geometry, x);
  const auto T = double_layer_moments(geometry, x);
  Blocks result;
  for (int a = 0; a < 3; ++a) {
    result.U[a] = kernel.single_layer_integral(U[a]);
    if (corners[a] != x) result.T[a] = Mat3(kernel.double_layer_integral(T[a], geometry.normal));
  }
  return result;
}

Real difference_U(const Blocks& a, const Blocks& exact) {
  Real worst = 0;
  for (int k = 0; k < 3; ++k) worst = std::max(worst, relative_difference(a.U[k], exact.U[k]));
  return worst;
}

Real difference_T(const Blocks& a, const Blocks& exact) {
  Real worst = 0;
  for (int k = 0; k < 3; ++k)
    if (exact.T[k]) worst = std::max(worst, relative_difference(*a.T[k], *exact.T[k]));
  return worst;
}

double distance_to_triangle(const std::array<Eigen::Vector3d, 3>& v, const Eigen::Vector3d& x) {
  const Eigen::Vector3d n = (v[1] - v[0]).cross(v[2] - v[0]);
  bool inside = true;
  double nearest = std::numeric_limits<double>::max();
  for (int e = 0; e < 3; ++e) {
    const Eigen::Vector3d& a = v[(e + 1) % 3];
    const Eigen::Vector3d edge = v[(e + 2) % 3] - a;
    if (edge.cross(x - a).dot(n) < 0) inside = false;
    const double s = std::clamp(edge.dot(x - a) / edge.squaredNorm(), 0.0, 1.0);
    nearest = std::min(nearest, (a + s * edge - x).norm());
  }
  return inside ? std::min(nearest, std::abs(n.dot(x - v[0])) / n.norm()) : nearest;
}

}  // namespace skinbem::oracle
