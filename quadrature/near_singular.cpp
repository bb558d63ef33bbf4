// SPDX-License-Identifier: BSD-3-Clause
#include <algorithm>
#include <limits>
#include <numbers>
#include <skinbem/quadrature/near_singular.hpp>
#include <stdexcept>

namespace skinbem {
namespace {

using std::numbers::pi;

/// A kernel without a length of its own leaves a polynomial of degree at most 2 along a ray from x.
constexpr int points_of_homogeneous_kernel = 3;

/// Beyond this ratio of distance to size the sinh transforms are straight lines, up to rounding that they would add.
constexpr double straight = 3.0;

/// Logarithms of the constants C of the error C rho^(-2n), measured over all classes of positions, shapes and
/// tolerances (docs/quadrature.md): from ray to ray, and along a ray, where the double layer's poles are of fourth
/// order.
constexpr double margin_across = 7.5;
constexpr double margin_along = 9.0;
constexpr double margin_trigonometric = 3.0;

/// The disc pays where x is closer to c than this fraction of its radius: a full disc, a sector.
constexpr double disc_pays = 1.0;
constexpr double sector_pays = 0.1;
constexpr int full_disc_rays = 6;

/// log rho of the ellipse with foci `begin` and `end` through the point i pole, rho the sum of its half axes in units
/// of half the distance of the foci.
double log_ellipse(double begin, double end, double pole) {
  const double middle = 0.5 * (begin + end), half = 0.5 * (end - begin);
  const double a = 0.5 * (std::hypot(middle - half, pole) + std::hypot(middle + half, pole)) / half;
  return std::log(a + std::sqrt(std::max(0.0, a * a - 1.0)));
}

void check(const TriangleGeometry<double>& triangle, const Eigen::Vector3d& x) {
  const double longest = *std::max_element(triangle.edge_lengths.begin(), triangle.edge_lengths.end());
  if (!x.allFinite() || !std::isfinite(longest)) throw std::invalid_argument("near-singular rule: not finite");
  if (!(longest >= 1e-50 && longest <= 1e50))
    throw std::invalid_argument("near-singular rule: the longest edge is outside [1e-50, 1e50]; choose another unit");
  if (!(triangle.twice_area > 1e-14 * longest * longest))
    throw std::invalid_argument("near-singular rule: the triangle has no area");
}

}  // namespace

NearSingularRule::NearSingularRule(const TriangleGeometry<double>& triangle, const Vector& x, double tolerance)
    : triangle_(&triangle), digits_(-std::log(std::clamp(tolerance, 1e-15, 0.1))) {
  check(triangle, x);
  frame_.row(0) = triangle.tangents[0];
  frame_.row(1) = -triangle.edge_normals[0];
  frame_.row(2) = triangle.normal;
  for (int e = 0; e < 3; ++e) {
    tangents_.col(e) = (frame_ * triangle.tangents[e]).head<2>();
    gradients_.col(e) = (frame_ * triangle.hat_gradients[e]).head<2>();
  }
  find_closest_point(x);
  for (double& hat : hats_c_)
    if (hat < closed_form_detail::touching) hat = 0;  // c on the edge: the rays to it would underflow
  const double longest = *std::max_element(triangle.edge_lengths.begin(), triangle.edge_lengths.end());
  if (delta_ > 0 && delta_ < smallest_distance * longest) {
    to_c_ *= smallest_distance * longest / delta_;
    delta_ = smallest_distance * longest;
  }
  near_ = delta_ < straight * longest;
  choose_disc();
  for (int e = 0; e < 3; ++e)
    if (hats_c_[e] > 0) add_wedges(e);
}

/// Sets hats_c_, to_c_, delta_. Heights are measured from the nearest vertex, hats from the nearest end of their edge,
/// so that tiny distances keep their digits.
void NearSingularRule::find_closest_point(const Vector& x) {
  const auto& g = *triangle_;
  int near = 0;
  for (int i = 1; i < 3; ++i)
    if ((g.vertices[i] - x).squaredNorm() < (g.vertices[near] - x).squaredNorm()) near = i;
  const Vector to_near = g.vertices[near] - x;

  const double height = g.normal.dot(to_near);
  for (int e = 0; e < 3; ++e) {
    const Vector to_first = g.vertices[(e + 1) % 3] - x, to_second = g.vertices[(e + 2) % 3] - x;
    hats_c_[e] = -g.hat_gradients[e].dot(to_first.squaredNorm() < to_second.squaredNorm() ? to_first : to_second);
  }
  if (hats_c_.minCoeff() > 0) {
    to_c_ = {0, 0, height};
    delta_ = std::abs(height);
    return snap_to_edges();
  }
  // x projects outside: the closest point is on an edge that x is beyond, or a vertex
  delta_ = -1;
  const Vector hats = hats_c_;
  for (int e = 0; e < 3; ++e) {
    if (hats[e] > 0) continue;
    const int i = (e + 1) % 3, j = (e + 2) % 3;
    const int from =
        near == j || (near == e && (g.vertices[j] - x).squaredNorm() < (g.vertices[i] - x).squaredNorm()) ? j : i;
    const Vector to_from = g.vertices[from] - x;
    const Vector along = from == i ? g.tangents[e] : Vector(-g.tangents[e]);
    const double length = g.edge_lengths[e];
    const double s = std::clamp(-along.dot(to_from), 0.0, length);
    Vector to_c = to_from;
    if (s == length) {
      to_c = g.vertices[from == i ? j : i] - x;
    } else if (s > 0) {
      to_c += s * along;
      to_c -= along.dot(to_c) * along;  // what rounding left along the edge would count where x is very close to it
    }
    const double distance = to_c.norm();
    if (delta_ >= 0 && distance >= delta_) continue;
    delta_ = distance;
    to_c_ = {frame_.row(0).dot(to_c), frame_.row(1).dot(to_c), height};
    hats_c_[e] = 0;
    hats_c_[from] = 1.0 - s / length;
    hats_c_[from == i ? j : i] = s / length;
  }
}

/// A strip between c and an edge that is thinner than the tolerance allows us to see is left out: c is taken as lying
/// on the edge.
void NearSingularRule::snap_to_edges() {
  const double share = 0.01 * std::exp(-digits_);
  for (int e = 0; e < 3; ++e) {
    const double height = triangle_->twice_area / triangle_->edge_lengths[e];
    if (hats_c_[e] * height < share * std::min(delta_, height)) hats_c_[e] = 0;
  }
}

/// The rays from c to edge `e`: one fan, or two with a common ray at the foot of x, whichever takes fewer.
void NearSingularRule::add_wedges(int e) {
  const auto& g = *triangle_;
  const int i = (e + 1) % 3, j = (e + 2) % 3;
  const double length = g.edge_lengths[e];
  Wedge wedge{};
  wedge.edge = e;
  wedge.d = hats_c_[e] * g.twice_area / length;
  // c to the ends of the edge, from its hats: exact however close
  const Vector to_first = -hats_c_[j] * length * g.tangents[e] + hats_c_[e] * g.edge_lengths[j] * g.tangents[j];
  const Vector to_second = hats_c_[i] * length * g.tangents[e] - hats_c_[e] * g.edge_lengths[i] * g.tangents[i];
  const double s_begin = g.tangents[e].dot(to_first);
  const double s_end = g.tangents[e].dot(to_second);
  const Eigen::Vector2d aside = to_c_.head<2>();
  wedge.s_foot = -tangent(e).dot(aside);
  double from_line = std::hypot(to_c_[2], wedge.d + outward(e).dot(aside));
  if (disc_ > 0) {
    // the disc cut away leaves the singularity of the direction at c's foot, in place of that of r at the foot of x
    wedge.s_foot = 0;
    from_line = wedge.d;
  }
  const double beyond = std::max({0.0, s_begin - wedge.s_foot, wedge.s_foot - s_end});
  const double scale = std::max(from_line, beyond);
  if (scale > straight * length) {
    wedge.v_begin = s_begin;
    wedge.v_end = s_end;
    wedge.rays = points_for((s_begin - wedge.s_foot) / scale, (s_end - wedge.s_foot) / scale, from_line / scale);
    wedge.scale = 0;
    wedges_[wedge_count_++] = wedge;
    return;
  }
  wedge.scale = scale;
  wedge.v_begin = std::asinh((s_begin - wedge.s_foot) / scale);
  wedge.v_end = std::asinh((s_end - wedge.s_foot) / scale);
  const double pole = std::asin(std::min(1.0, from_line / scale));
  wedge.rays = points_for(wedge.v_begin, wedge.v_end, pole);
  if (wedge.v_begin < 0 && wedge.v_end > 0) {
    Wedge left = wedge, right = wedge;
    left.v_end = right.v_begin = 0;
    left.rays = points_for(left.v_begin, 0, pole);
    right.rays = points_for(0, right.v_end, pole);
    if (left.rays + right.rays < wedge.rays) {
      wedges_[wedge_count_++] = left;
      wedges_[wedge_count_++] = right;
      return;
    }
  }
  wedges_[wedge_count_++] = wedge;
}

/// Gauss points on [begin, end] for an integrand with its nearest singularities at +-i pole.
int NearSingularRule::points_for(double begin, double end, double pole) const {
  if (!(end - begin > 1e-12)) return 1;
  const double n = (digits_ + margin_across) / (2.0 * log_ellipse(begin, end, pole)) + 1.0;
  return std::clamp(static_cast<int>(std::ceil(n)), 2, max_cached_gauss_order);
}

/// The same along a ray, in the variable of the radial transforms.
int NearSingularRule::points_on_ray(double begin, double end) const {
  if (!(end - begin > 1e-12)) return 1;
  const double length = end - begin;
  begin = std::min(begin, 0.5 * pi);  // farther out the growth of e^u limits, not the poles
  const double n = (digits_ + margin_along) / (2.0 * log_ellipse(begin, begin + length, 0.5 * pi)) + 1.0;
  return std::clamp(static_cast<int>(std::ceil(n)), 2, max_cached_gauss_order);
}

NearSingularRule::Ray NearSingularRule::ray_in_wedge(const Wedge& wedge, double v, double v_weight) const {
  double s = v, ds = v_weight;
  if (wedge.scale > 0) {
    const double grow = std::exp(v), decay = 1.0 / grow;
    s = wedge.s_foot + 0.5 * wedge.scale * (grow - decay);
    ds = 0.5 * wedge.scale * (grow + decay) * v_weight;
  }
  Ray ray;
  ray.R = std::sqrt(wedge.d * wedge.d + s * s);
  const int e = wedge.edge;
  ray.direction = (wedge.d * outward(e) + s * tangent(e)) / ray.R;
  for (int i = 0; i < 3; ++i) ray.hats[i] = gradients_.col(i).dot(ray.direction);
  ray.weight = wedge.d * ds / (ray.R * ray.R);
  if (delta_ > 0 && near_) {
    ray.radial = Radial::stretched;
    ray.u_begin = disc_ > 0 ? std::asinh(disc_ / delta_) : 0.0;
    ray.u_end = std::asinh(ray.R / delta_);
    ray.points = points_on_ray(ray.u_begin, ray.u_end);
  } else if (delta_ > 0 || disc_ == 0) {
    ray.radial = Radial::linear;
    ray.u_begin = 0;
    ray.u_end = ray.R;
    ray.points = delta_ > 0 ? points_for(0, ray.R / delta_, 1.0) : points_of_homogeneous_kernel;
  } else {
    ray.radial = Radial::powers;
    ray.u_begin = 0;
    ray.u_end = std::log(ray.R / disc_);
    ray.points = points_on_ray(0.5 * pi, 0.5 * pi + ray.u_end);
  }
  return ray;
}

NearSingularRule::Ray NearSingularRule::ray_in_disc(double angle, double angle_weight) const {
  Ray ray;
  ray.R = disc_;
  ray.direction = std::cos(angle) * tangent(disc_edge_) - std::sin(angle) * outward(disc_edge_);
  for (int i = 0; i < 3; ++i) ray.hats[i] = gradients_.col(i).dot(ray.direction);
  ray.weight = angle_weight;
  ray.u_begin = 0;
  if (delta_ > 0) {
    ray.radial = Radial::stretched;
    ray.u_end = std::asinh(disc_ / delta_);
    ray.points = points_on_ray(0, ray.u_end);
  } else {
    ray.radial = Radial::linear;
    ray.u_end = disc_;
    ray.points = points_of_homogeneous_kernel;
  }
  return ray;
}

/// A disc, half disc or sector about c, where x is close enough that its few rays save points.
void NearSingularRule::choose_disc() {
  const auto& g = *triangle_;
  double radius = std::numeric_limits<double>::max();
  int touched = 0, opposite = 0;  // edges that c lies on; the last one that it does not
  for (int e = 0; e < 3; ++e) {
    if (hats_c_[e] > 0) {
      radius = std::min(radius, hats_c_[e] * g.twice_area / g.edge_lengths[e]);
      opposite = e;
    } else {
      ++touched;
      disc_edge_ = e;
    }
  }
  if (touched == 0) {
    if (!(delta_ < disc_pays * radius)) return;
    sector_angle_ = 2.0 * pi;
    sector_rays_ = full_disc_rays;
  } else {
    if (!(delta_ < sector_pays * radius) || delta_ == 0) return;
    sector_angle_ = pi;
    if (touched == 2) {  // c is the corner `opposite`, between edges opposite + 2 and opposite + 1
      const int last = (opposite + 1) % 3;
      disc_edge_ = (opposite + 2) % 3;
      const double dot = -g.tangents[disc_edge_].dot(g.tangents[last]);
      sector_angle_ = std::atan2(g.twice_area, g.edge_lengths[disc_edge_] * g.edge_lengths[last] * dot);
    }
    sector_rays_ = points_in_sector();
  }
  disc_ = radius;
}

/// Gauss points in the angle of a sector: r vanishes at angles at least pi/2 outside of it, away from the real axis
/// unless x is in the plane; and the Gauss error for a trigonometric polynomial of degree k on an angle a is about
/// (e k a / (8 n))^(2n).
int NearSingularRule::points_in_sector() const {
  constexpr double degree = 4;
  const double aside = to_c_.head<2>().norm();
  const double pole = std::acosh(std::max(1.0, delta_ / std::max(aside, 1e-3 * delta_)));
  const double reach = std::numbers::e * degree * sector_angle_ / 8.0;
  int n = points_for(0.5 * pi, 0.5 * pi + sector_angle_, pole);
  while (2.0 * n * std::log(n / reach) < digits_ + margin_trigonometric) ++n;
  return n;
}

int NearSingularRule::size() const {
  int points = 0;
  for_each_ray([&](const Ray& ray) { points += ray.points; });
  return points;
}

}  // namespace skinbem
