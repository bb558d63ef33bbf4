// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Closed form of the moments of inverse powers of the distance over a flat triangle, against its three hat functions.
///
/// With x the field point, r = y - x, n the triangle's unit normal and d = r.n (constant on the triangle), rho the part
/// of r in the plane and N a hat function with (constant) surface gradient g:
///
///   rho / r^3         = -grad(1/r)                     so every moment becomes, by the divergence theorem in the
///   plane, 3 rho rho^T / r^5 = grad grad(1/r) + I_t / r^3     line integrals along the edges and the solid angle of
///   the triangle. 3 rho / r^5       = -grad(1/r^3)
///
/// On an edge with unit tangent tau, outward in-plane normal eta, arc length s from the foot of x's perpendicular,
/// q = rho.eta, w^2 = q^2 + d^2 and R^2 = s^2 + w^2 only these are needed:
///
///   L = int ds/R = log((R1+R2+l)/(R1+R2-l)),   J0 = int ds/R^3,   J1 = int s ds/R^3 = (R2-R1)/(R1 R2),
///   int s ds/R = R2-R1,   int s^2 ds/R = (s2 R2 - s1 R1 - w^2 L)/2,   int s^2 ds/R^3 = L - w^2 J0,   int R ds = (s2 R2
///   - s1 R1 + w^2 L)/2
///
/// each written below without a difference of nearly equal numbers. The in-plane reduction is that of Graglia, IEEE
/// Trans. Antennas Propag. 41 (1993) 1448; the solid angle is van Oosterom and Strackee, IEEE Trans. Biomed. Eng. 30
/// (1983) 125. Rounding grows like (distance / smallest height)^2 as x moves away: the form is meant for points near
/// the triangle; far away a Gauss rule is both cheaper and exact.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

#include <array>
#include <cmath>

namespace skinbem {

/// What the closed form needs of a triangle, computed once.
template <class T>
struct TriangleGeometry {
  using Vector = Eigen::Matrix<T, 3, 1>;

  std::array<Vector, 3> vertices;       ///< counter-clockwise about the normal
  std::array<Vector, 3> tangents;       ///< unit, of edge e: from vertex e+1 to e+2 (opposite to vertex e)
  std::array<Vector, 3> edge_normals;   ///< unit, in the plane, outward
  std::array<Vector, 3> hat_gradients;  ///< of the hat function of vertex e: -edge_normals[e] / height over edge e
  std::array<T, 3> edge_lengths;
  Vector normal;  ///< unit
  T twice_area;

  /// The triangle must have positive area: three distinct, not collinear vertices.
  TriangleGeometry(const Vector& v0, const Vector& v1, const Vector& v2) : vertices{v0, v1, v2} {
    using std::sqrt;
    std::array<Vector, 3> edges = {v2 - v1, v0 - v2, v1 - v0};
    std::array<T, 3> squares;
    for (int e = 0; e < 3; ++e) squares[e] = edges[e].squaredNorm();
    // the cross product of the two shortest edges is the most accurate one
    const int longest = squares[0] > squares[1] ? (squares[0] > squares[2] ? 0 : 2) : (squares[1] > squares[2] ? 1 : 2);
    const Vector cross = edges[(longest + 1) % 3].cross(edges[(longest + 2) % 3]);
    twice_area = sqrt(cross.squaredNorm());
    for (int e = 0; e < 3; ++e) {
      edge_lengths[e] = sqrt(squares[e]);
      tangents[e] = edges[e] / edge_lengths[e];
    }
    normal = cross / twice_area;
    normal -= normal.dot(tangents[longest]) * tangents[longest];  // a needle's cross product leans along it
    for (int e = 0; e < 3; ++e) {
      edge_normals[e] = tangents[e].cross(normal);
      hat_gradients[e] = edge_normals[e] * (-edge_lengths[e] / twice_area);
    }
  }
};

/// Moments for a kernel like 1/r (single layer), against the hat function of one vertex.
template <class T>
struct SingleLayerMoments {
  T inverse_distance;           ///< int N / r dS
  Eigen::Matrix<T, 3, 3> dyad;  ///< int N r r^T / r^3 dS

  template <class U>
  SingleLayerMoments<U> cast() const {
    return {U(inverse_distance), dyad.template cast<U>()};
  }
};

/// Moments for a kernel like 1/r^2 (double layer), against the hat function of one vertex.
template <class T>
struct DoubleLayerMoments {
  T solid_angle;                      ///< int N (r.n) / r^3 dS
  Eigen::Matrix<T, 3, 1> attraction;  ///< int N r / r^3 dS
  Eigen::Matrix<T, 3, 3> dyad;        ///< int N 3 (r.n) r r^T / r^5 dS

  template <class U>
  DoubleLayerMoments<U> cast() const {
    return {U(solid_angle), attraction.template cast<U>(), dyad.template cast<U>()};
  }
};

namespace closed_form_detail {

/// Nearer to a vertex or an edge than this, in lengths of the triangle, x counts as on it: squares of smaller numbers
/// underflow.
inline constexpr double touching = 1e-60;

/// The line integrals along one edge, from vertex 1 at s1 to vertex 2 at s2.
template <class T>
struct EdgeIntegrals {
  T q, s1, s2, R1, R2, w2;
  T dR;      ///< R2 - R1
  T L;       ///< int 1/R
  T J0;      ///< int 1/R^3
  T J1;      ///< int s/R^3
  T first;   ///< int N/R for the hat function of vertex 1, ...
  T second;  ///< ... of vertex 2

  T square() const { return (s2 * R2 - s1 * R1 - w2 * L) / T(2); }  ///< int s^2/R
  T length() const { return (s2 * R2 - s1 * R1 + w2 * L) / T(2); }  ///< int R
};

/// Everything that depends on x and the triangle, shared by the moments of both layers.
template <class T>
struct View {
  using Vector = Eigen::Matrix<T, 3, 1>;
  T d;                                    ///< signed height: (y - x).n
  T solid_angle;                          ///< d int 1/r^3; 0 in the plane (principal value)
  T inverse_distance;                     ///< int 1/r
  std::array<T, 3> hats;                  ///< hat functions at the projection of x
  std::array<EdgeIntegrals<T>, 3> edges;  ///< edge e is opposite to vertex e
};

template <class T>
EdgeIntegrals<T> integrate_edge(T q, T d, T s1, T s2, T R1, T R2, T length) {
  using std::abs;
  using std::log1p;
  EdgeIntegrals<T> e{};
  e.q = q;
  e.s1 = s1;
  e.s2 = s2;
  e.R1 = R1;
  e.R2 = R2;
  e.w2 = q * q + d * d;
  const T sum = R1 + R2;
  e.dR = length * (s1 + s2) / sum;
  const bool on_line = !(e.w2 > T(touching * touching) * length * length);
  if (s1 < T(0) && s2 > T(0)) {
    if (!on_line) {
      const T gap = e.w2 / (R2 + s2) + e.w2 / (R1 - s1);  // R1 + R2 - length
      e.L = log1p(T(2) * length / gap);
      e.J0 = (s2 / R2 - s1 / R1) / e.w2;
      e.J1 = e.dR / (R1 * R2);
    }
  } else if (R1 > T(0) && R2 > T(0)) {
    const T near = abs(s1) < abs(s2) ? R1 + abs(s1) : R2 + abs(s2);
    const T far = abs(s1) < abs(s2) ? R2 + abs(s2) : R1 + abs(s1);
    e.L = log1p(T(2) * length / (near + e.w2 / far));
    e.J0 = length * abs(s1 + s2) / (R1 * R2 * (abs(s2) * R1 + abs(s1) * R2));
    e.J1 = e.dR / (R1 * R2);
  }
  // Where the edge touches x only finite parts are left: what diverges belongs to the hat of the touched vertex, whose
  // double layer does not exist on a single triangle, or is multiplied by q = d = 0.
  e.first = (s2 * e.L - e.dR) / length;
  e.second = (e.dR - s1 * e.L) / length;
  return e;
}

/// int (r.n)/r^3, the signed solid angle: from the three directions at once (van Oosterom and Strackee) where the
/// denominator's cancellation costs less than the rounding of an angle of size 1, always so for x almost in the plane
/// outside; else (x close to the triangle) edge by edge: the angle of (q s, w^2 + |d| R) between the ends of each edge.
template <class T>
T solid_angle(const TriangleGeometry<T>& g, const std::array<Eigen::Matrix<T, 3, 1>, 3>& a, const std::array<T, 3>& R,
              T d, const std::array<EdgeIntegrals<T>, 3>& edges) {
  using std::abs;
  using std::atan2;
  if (d == T(0)) return T(0);
  const T product = R[0] * R[1] * R[2];
  const T denominator = product + a[0].dot(a[1]) * R[2] + a[1].dot(a[2]) * R[0] + a[2].dot(a[0]) * R[1];
  const T numerator = d * g.twice_area;
  if (denominator > product || (denominator > T(0) && abs(numerator) * product < denominator * denominator))
    return T(2) * atan2(numerator, denominator);
  T sum = T(0);
  for (const auto& e : edges) {
    sum += atan2(e.q * e.s2, e.w2 + abs(d) * e.R2) - atan2(e.q * e.s1, e.w2 + abs(d) * e.R1);
  }
  return d > T(0) ? sum : -sum;
}

template <class T>
View<T> look_from(const TriangleGeometry<T>& g, const Eigen::Matrix<T, 3, 1>& x) {
  using std::sqrt;
  View<T> view{};
  std::array<Eigen::Matrix<T, 3, 1>, 3> a;
  std::array<T, 3> R;
  const T reach = T(touching) * g.edge_lengths[0];
  for (int i = 0; i < 3; ++i) {
    a[i] = g.vertices[i] - x;
    if (!(a[i].cwiseAbs().maxCoeff() > reach)) a[i].setZero();
    R[i] = sqrt(a[i].squaredNorm());
  }
  // heights and hats are measured from the nearest vertex, where they lose least
  const int c = R[0] < R[1] ? (R[0] < R[2] ? 0 : 2) : (R[1] < R[2] ? 1 : 2);
  view.d = g.normal.dot(a[c]);
  for (int i = 0; i < 3; ++i) view.hats[i] = T(i == c ? 1 : 0) - g.hat_gradients[i].dot(a[c]);
  for (int e = 0; e < 3; ++e) {
    const int i = (e + 1) % 3;
    const int j = (e + 2) % 3;
    const T q = g.edge_normals[e].dot(R[i] < R[j] ? a[i] : a[j]);
    const bool at_end = !(R[i] > T(0)) || !(R[j] > T(0));
    view.edges[e] = integrate_edge(at_end ? T(0) : q, view.d, g.tangents[e].dot(a[i]), g.tangents[e].dot(a[j]), R[i],
                                   R[j], g.edge_lengths[e]);
    view.inverse_distance += view.edges[e].q * view.edges[e].L;
  }
  view.solid_angle = solid_angle(g, a, R, view.d, view.edges);
  view.inverse_distance -= view.d * view.solid_angle;
  return view;
}

}  // namespace closed_form_detail

/// Moments of the single layer at x, one per vertex. Finite for every finite x, on the triangle too.
template <class T>
std::array<SingleLayerMoments<T>, 3> single_layer_moments(const TriangleGeometry<T>& g,
                                                          const Eigen::Matrix<T, 3, 1>& x) {
  using Vector = Eigen::Matrix<T, 3, 1>;
  using Matrix = Eigen::Matrix<T, 3, 3>;
  const auto view = closed_form_detail::look_from(g, x);
  const T d = view.d;
  const Vector& n = g.normal;
  const Matrix in_plane = Matrix::Identity() - n * n.transpose();

  Vector rho_over_r = Vector::Zero();  // int rho / r
  Vector rho_over_r3 = Vector::Zero();
  for (int e = 0; e < 3; ++e) {
    rho_over_r += g.edge_normals[e] * view.edges[e].length();
    rho_over_r3 -= g.edge_normals[e] * view.edges[e].L;
  }
  std::array<SingleLayerMoments<T>, 3> moments;
  for (int v = 0; v < 3; ++v) {
    const Vector& gradient = g.hat_gradients[v];
    const T inverse_distance = view.hats[v] * view.inverse_distance + gradient.dot(rho_over_r);
    const T solid_angle = view.hats[v] * view.solid_angle + d * gradient.dot(rho_over_r3);
    Vector attraction = gradient * view.inverse_distance;  // int N rho / r^3
    Matrix dyad = gradient * rho_over_r.transpose() + inverse_distance * in_plane;
    for (int k = 1; k <= 2; ++k) {  // the two edges on which this hat function does not vanish
      const int e = (v + k) % 3;
      const auto& edge = view.edges[e];
      const bool at_second = k == 1;  // edge v+1 runs from vertex v+2 to v
      const T weight = at_second ? edge.second : edge.first;
      const T first_moment = at_second ? (edge.square() - edge.s1 * edge.dR) / g.edge_lengths[e]
                                       : (edge.s2 * edge.dR - edge.square()) / g.edge_lengths[e];  // int N s/R
      attraction -= g.edge_normals[e] * weight;
      dyad -= g.edge_normals[e] * (g.edge_normals[e] * (edge.q * weight) + g.tangents[e] * first_moment).transpose();
    }
    dyad += d * (attraction * n.transpose() + n * attraction.transpose()) + d * solid_angle * n * n.transpose();
    moments[v] = {inverse_distance, (dyad + dyad.transpose()) / T(2)};
  }
  return moments;
}

/// Moments of the double layer at x, one per vertex. In the plane, inside the triangle: the principal value. At a
/// vertex of the triangle the moments of its own hat function do not exist (the value returned is finite and means
/// nothing); the others do.
template <class T>
std::array<DoubleLayerMoments<T>, 3> double_layer_moments(const TriangleGeometry<T>& g,
                                                          const Eigen::Matrix<T, 3, 1>& x) {
  using Vector = Eigen::Matrix<T, 3, 1>;
  using Matrix = Eigen::Matrix<T, 3, 3>;
  const auto view = closed_form_detail::look_from(g, x);
  const T d = view.d;
  const Vector& n = g.normal;
  const Matrix in_plane = Matrix::Identity() - n * n.transpose();

  Vector rho_over_r3 = Vector::Zero();
  for (int e = 0; e < 3; ++e) rho_over_r3 -= g.edge_normals[e] * view.edges[e].L;

  std::array<DoubleLayerMoments<T>, 3> moments;
  for (int v = 0; v < 3; ++v) {
    const Vector& gradient = g.hat_gradients[v];
    const T solid_angle = view.hats[v] * view.solid_angle + d * gradient.dot(rho_over_r3);
    Vector attraction = gradient * view.inverse_distance;  // its part in the plane
    Vector slant = gradient * view.solid_angle;  // int 3 d N rho / r^5 = d (gradient int 1/r^3 - sum eta int N/R^3)
    Matrix tangential = d * gradient * rho_over_r3.transpose();
    for (int k = 1; k <= 2; ++k) {
      const int e = (v + k) % 3;
      const auto& edge = view.edges[e];
      const T l = g.edge_lengths[e];
      const bool at_second = k == 1;
      const T J2 = edge.L - edge.w2 * edge.J0;
      const T weight = at_second ? edge.second : edge.first;
      const T zeroth = (at_second ? edge.J1 - edge.s1 * edge.J0 : edge.s2 * edge.J0 - edge.J1) / l;  // int N/R^3
      const T first = (at_second ? J2 - edge.s1 * edge.J1 : edge.s2 * edge.J1 - J2) / l;             // int N s/R^3
      attraction -= g.edge_normals[e] * weight;
      slant -= g.edge_normals[e] * (d * zeroth);
      tangential -= d * g.edge_normals[e] * (g.edge_normals[e] * (edge.q * zeroth) + g.tangents[e] * first).transpose();
    }
    tangential = (tangential + tangential.transpose().eval()) / T(2) + solid_angle * in_plane;
    const T normal_part = T(3) * solid_angle - tangential.trace();  // the trace of the whole is 3 int N d / r^3
    moments[v] = {solid_angle, attraction + solid_angle * n,
                  tangential + d * (slant * n.transpose() + n * slant.transpose()) + normal_part * n * n.transpose()};
  }
  return moments;
}

}  // namespace skinbem
