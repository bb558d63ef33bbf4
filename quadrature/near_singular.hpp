// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A Gauss rule for kernels that are singular or nearly singular on a flat triangle.
///
/// Let c be the point of the triangle closest to x, delta = |x - c|. The triangle is cut into the (at most three)
/// triangles between c and those edges that c does not lie on. In each, with d the distance from c to the edge's line,
/// s the arc length along that line from the foot of c, and R(s)^2 = d^2 + s^2,
///
///   y = c + t (d eta + s tau),   0 <= t <= 1,   dA = d t dt ds                           (polar coordinates about c)
///   t R = delta sinh u,   0 <= u <= asinh(R / delta)                                     (radial)
///   s = s_x + D sinh v,   D the distance from x to the edge, s_x its foot on the line    (along the edge)
///
/// and Gauss-Legendre in u and v. Since c is the closest point, (c - x).(y - c) >= 0 in the whole triangle: no weight
/// is negative, nothing cancels, and r vanishes only at complex u at least asinh 1 away from the interval of
/// integration; without offset in the plane at u = +-i pi/2. Along the edge the singularities s_x +- i D go to v = +-i
/// pi/2. So a kernel r^-p times a polynomial becomes analytic in strips whose width does not depend on the distance,
/// and the number of points grows like the root of log(size / distance). Where x is very close, the part of a disc
/// about c that touches the nearest of those edges is integrated by itself: there a kernel is a trigonometric
/// polynomial of low degree in the angle (x above c) or nearly so. Six directions integrate it over the whole disc
/// exactly, ten or so over a half disc (c on an edge) or a sector (c at a corner), so the many radial points are needed
/// on few rays only.
///
/// In the plane (delta = 0): c at a corner or on an edge is Duffy's transform (kernels r^-1 times a polynomial; r^-2
/// against a hat function that vanishes there). c inside: a kernel r^-2, odd about c, comes out as Cauchy's principal
/// value, since the six directions are opposite in pairs.
///
/// The numbers of points follow from the Bernstein ellipse through the nearest singularity: the error of n Gauss points
/// is about C rho^(-2n), rho the sum of the ellipse's half axes.
///
/// Sources: M. G. Duffy, SIAM J. Numer. Anal. 19 (1982) 1260; P. R. Johnston and D. Elliott, Int. J. Numer. Meth. Engng
/// 62 (2005) 564 (the sinh transform); M. A. Khayat and D. R. Wilton, IEEE Trans. Antennas Propag. 53 (2005) 3180
/// (cancelling the singularity by the radial variable); L. N. Trefethen, SIAM Review 50 (2008) 67 (the ellipse).
#pragma once

#include <Eigen/Core>
#include <array>
#include <cmath>
#include <skinbem/quadrature/closed_form.hpp>
#include <skinbem/quadrature/gauss_legendre.hpp>

namespace skinbem {

/// The points for one triangle seen from one point x, chosen for a tolerance. A small value without allocation: make
/// it, visit it, forget it.
///
/// Promise: for a kernel of the form r^-p times a polynomial in r_i / r and n_i with p = 1 or 2, of angular degree at
/// most 4 (Laplace, Kelvin, Stokes), times a linear hat function, the error is below `tolerance` times the largest
/// entry of the kernel's integral, or at the rounding of double: for any position of x, at a distance from 1e-16 of the
/// longest edge to far away, and any aspect ratio up to 1e6.
class NearSingularRule {
 public:
  /// Distances below this fraction of the longest edge, other than zero, are raised to it (x is moved away from the
  /// triangle along the line from c): the integrals then differ from their limit by less than rounding, where there is
  /// a limit, and nothing underflows.
  static constexpr double smallest_distance = 1e-30;

  /// `tolerance` in [1e-15, 0.1], clamped. `triangle` must outlive the rule. Throws std::invalid_argument when the
  /// triangle has no area (twice the area not above 1e-14 longest edge^2), when x or the triangle is not finite, or
  /// when the longest edge is outside [1e-50, 1e50] (powers of r would leave the range of double).
  NearSingularRule(const TriangleGeometry<double>& triangle, const Eigen::Vector3d& x, double tolerance);

  /// Number of points, hence of kernel evaluations.
  int size() const;
  /// From x to the triangle.
  double distance() const { return delta_; }

  /// The triangle's own frame, an orthonormal 3 x 3 matrix whose rows are two axes in the plane and the normal.
  const Eigen::Matrix3d& frame() const { return frame_; }

  /// Calls f(r, barycentric, weight) at every point: r = y - x in the triangle's frame, `const Eigen::Vector3d&`; the
  /// barycentric coordinates of y, `const Eigen::Vector3d&`, that is the three hat functions; and the weight, an area,
  /// > 0. In this frame the normal is (0, 0, 1) and r.n is the same number at every point, free of the rounding of a
  /// subtraction y - x and of a scalar product; that is worth seven digits where x is 1e-7 of the size away and nu =
  /// 1/2. Evaluate an isotropic kernel there and turn the sum: block = frame^T sum frame.
  template <class Visitor>
  void for_each(Visitor&& f) const;

 private:
  using Vector = Eigen::Vector3d;

  /// Rays from c to a piece of an edge.
  struct Wedge {
    int edge;              ///< opposite to vertex `edge`
    double d;              ///< from c to the edge's line
    double s_foot, scale;  ///< of s = s_foot + scale sinh v; where `scale` is 0, s = v
    double v_begin, v_end;
    int rays;
  };

  /// How the radius runs along a ray.
  enum class Radial {
    linear,     ///< rho = R u
    stretched,  ///< rho = delta sinh u
    powers,     ///< rho = disc radius e^u
  };

  /// A direction from c: rho = 0 ... R along `direction` (unit, in the frame), where the barycentric coordinates change
  /// by `hats` per unit of rho.
  struct Ray {
    Eigen::Vector2d direction;
    Vector hats;
    double R;
    double u_begin, u_end;
    Radial radial;
    int points;
    double weight;  ///< of the direction: dA = weight rho drho
  };

  Eigen::Vector2d tangent(int edge) const { return tangents_.col(edge); }
  Eigen::Vector2d outward(int edge) const { return {tangents_(1, edge), -tangents_(0, edge)}; }
  bool full_disc() const { return hats_c_.minCoeff() > 0; }
  void find_closest_point(const Vector& x);
  void snap_to_edges();
  void add_wedges(int edge);
  void choose_disc();
  int points_in_sector() const;
  int points_for(double begin, double end, double pole) const;
  int points_on_ray(double begin, double end) const;
  Ray ray_in_wedge(const Wedge& wedge, double v, double v_weight) const;
  Ray ray_in_disc(double angle, double angle_weight) const;
  template <class Visitor>
  void for_each_ray(Visitor&& f) const;
  template <class Visitor>
  void for_each_on(const Ray& ray, Visitor&& f) const;

  const TriangleGeometry<double>* triangle_;
  Eigen::Matrix3d frame_;
  Eigen::Matrix<double, 2, 3> tangents_, gradients_;  ///< of the edges, of the hats; in the frame
  double digits_;                                     ///< log(1 / tolerance)
  Vector hats_c_;                                     ///< barycentric coordinates of c
  Vector to_c_;                                       ///< c - x
  double delta_;                                      ///< |c - x|
  bool near_;                                         ///< the sinh transforms are worth while

  double disc_ = 0;    ///< radius of the disc (sector) about c that is integrated by itself; 0: none
  int disc_edge_ = 0;  ///< angles are measured from its tangent into the triangle, 0 ... sector_angle_
  double sector_angle_ = 0;
  int sector_rays_ = 0;

  std::array<Wedge, 6> wedges_;
  int wedge_count_ = 0;
};

template <class Visitor>
void NearSingularRule::for_each_ray(Visitor&& f) const {
  if (disc_ > 0) {
    if (full_disc()) {
      for (int k = 0; k < sector_rays_; ++k)
        f(ray_in_disc(sector_angle_ * k / sector_rays_, sector_angle_ / sector_rays_));
    } else {
      const GaussView gauss = gauss_legendre(sector_rays_);
      for (int k = 0; k < sector_rays_; ++k)
        f(ray_in_disc(sector_angle_ * gauss.nodes[k], sector_angle_ * gauss.weights[k]));
    }
  }
  for (int w = 0; w < wedge_count_; ++w) {
    const Wedge& wedge = wedges_[w];
    const GaussView gauss = gauss_legendre(wedge.rays);
    const double length = wedge.v_end - wedge.v_begin;
    for (int j = 0; j < wedge.rays; ++j)
      f(ray_in_wedge(wedge, wedge.v_begin + length * gauss.nodes[j], length * gauss.weights[j]));
  }
}

template <class Visitor>
void NearSingularRule::for_each_on(const Ray& ray, Visitor&& f) const {
  const GaussView gauss = gauss_legendre(ray.points);
  const double length = ray.u_end - ray.u_begin;
  for (int i = 0; i < ray.points; ++i) {
    const double u = ray.u_begin + length * gauss.nodes[i];
    double rho, drho;
    if (ray.radial == Radial::linear) {
      rho = u;
      drho = length * gauss.weights[i];
    } else {
      const double grow = std::exp(u);
      const double decay = ray.radial == Radial::stretched ? 1.0 / grow : 0.0;
      const double scale = ray.radial == Radial::stretched ? 0.5 * delta_ : disc_;
      rho = scale * (grow - decay);
      drho = scale * (grow + decay) * length * gauss.weights[i];
    }
    const Vector r(to_c_[0] + rho * ray.direction[0], to_c_[1] + rho * ray.direction[1], to_c_[2]);
    const Vector hats = hats_c_ + rho * ray.hats;
    f(r, hats, ray.weight * rho * drho);
  }
}

template <class Visitor>
void NearSingularRule::for_each(Visitor&& f) const {
  for_each_ray([&](const Ray& ray) { for_each_on(ray, f); });
}

}  // namespace skinbem
