// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// make_triangle_rules FILE: computes the symmetric triangle rules and writes quadrature/triangle_rules_table.hpp.
///
/// A rule with the symmetry of the triangle is exact to degree d when it is so for the symmetric polynomials, that is
/// for the products of e2 = ab + bc + ca and e3 = abc of weighted degree at most d in the barycentric coordinates a, b,
/// c. From random starts, Levenberg and Marquardt's method in double looks for a solution with all points inside and
/// all weights positive; Newton's method in quadruple precision polishes it to 30 digits. Minutes to degree 12; degree
/// 13 needs some 100,000 starts.
#include <Eigen/Cholesky>
#include <Eigen/QR>
#include <algorithm>
#include <boost/multiprecision/eigen.hpp>
#include <boost/multiprecision/float128.hpp>
#include <iostream>
#include <random>
#include <skinbem/base/atomic_file.hpp>
#include <skinbem/quadrature/gauss_legendre.hpp>

namespace {

using Quad = boost::multiprecision::float128;
template <class T>
using Matrix = Eigen::Matrix<T, Eigen::Dynamic, Eigen::Dynamic>;
template <class T>
using Vector = Eigen::Matrix<T, Eigen::Dynamic, 1>;

/// Numbers of orbits of one, three and six points.
struct Structure {
  int degree, centroid, of_3, of_6;
  int unknowns() const { return centroid + 2 * of_3 + 3 * of_6; }
  int points() const { return centroid + 3 * of_3 + 6 * of_6; }
};

constexpr Structure structures[] = {{1, 1, 0, 0},  {2, 0, 1, 0},  {4, 0, 2, 0}, {5, 1, 2, 0},  {6, 0, 2, 1},
                                    {7, 0, 3, 1},  {8, 1, 3, 1},  {9, 1, 4, 1}, {10, 1, 2, 3}, {11, 1, 5, 2},
                                    {12, 0, 5, 3}, {13, 1, 6, 3}, {14, 0, 6, 4}};

/// Legendre polynomials P_0 ... P_n on [-1, 1] and their derivatives.
template <class T>
void legendre(int n, T x, T* P, T* D) {
  P[0] = 1;
  D[0] = 0;
  for (int k = 1; k <= n; ++k) {
    P[k] = k == 1 ? x : T((T(2 * k - 1) * x * P[k - 1] - T(k - 1) * P[k - 2]) / T(k));
    D[k] = T(k) * P[k - 1] + x * D[k - 1];
  }
}

/// The moment equations of one degree: residual(p) = 0.
template <class T>
class MomentEquations {
 public:
  explicit MomentEquations(const Structure& structure) : structure_(structure) {
    for (int j = 0; 3 * j <= structure.degree; ++j)
      for (int i = 0; 2 * i + 3 * j <= structure.degree; ++i) powers_.push_back({i, j});
    const auto count = static_cast<Eigen::Index>(powers_.size());
    for (auto* v : {&value_, &d_a_, &d_b_, &exact_}) v->setZero(count);
    const auto gauss = skinbem::make_gauss_legendre<T>(structure.degree / 2 + 2);
    for (std::size_t i = 0; i < gauss.nodes.size(); ++i)
      for (std::size_t j = 0; j < gauss.nodes.size(); ++j) {
        const T u = gauss.nodes[i];
        evaluate(T(1) - u, u * gauss.nodes[j]);
        exact_ += T(2) * u * gauss.weights[i] * gauss.weights[j] * value_;
      }
  }

  /// Parameters in the order of the table.
  void residual(const Vector<T>& p, Vector<T>& r, Matrix<T>& J) {
    r = -exact_;
    J.setZero(exact_.size(), p.size());
    Eigen::Index c = 0;
    if (structure_.centroid == 1) {
      evaluate(T(1) / T(3), T(1) / T(3));
      r += p[c] * value_;
      J.col(c++) = value_;
    }
    for (int k = 0; k < structure_.of_3; ++k, c += 2) {
      evaluate(p[c], p[c]);
      r += T(3) * p[c + 1] * value_;
      J.col(c) = T(3) * p[c + 1] * (d_a_ + d_b_);
      J.col(c + 1) = T(3) * value_;
    }
    for (int k = 0; k < structure_.of_6; ++k, c += 3) {
      evaluate(p[c], p[c + 1]);
      r += T(6) * p[c + 2] * value_;
      J.col(c) = T(6) * p[c + 2] * d_a_;
      J.col(c + 1) = T(6) * p[c + 2] * d_b_;
      J.col(c + 2) = T(6) * value_;
    }
  }

 private:
  /// The basis P_i(6 e2 - 1) P_j(54 e3 - 1) at (a, b, 1 - a - b), and its derivatives by a and b.
  void evaluate(T a, T b) {
    const T c = T(1) - a - b;
    const T e2 = a * b + c * (a + b), e3 = a * b * c;
    T P[16], dP[16], Q[16], dQ[16];
    legendre(structure_.degree / 2, T(T(6) * e2 - T(1)), P, dP);
    legendre(structure_.degree / 3, T(T(54) * e3 - T(1)), Q, dQ);
    for (std::size_t k = 0; k < powers_.size(); ++k) {
      const auto [i, j] = powers_[k];
      const T by_e2 = T(6) * dP[i] * Q[j], by_e3 = T(54) * P[i] * dQ[j];
      const auto row = static_cast<Eigen::Index>(k);
      value_[row] = P[i] * Q[j];
      d_a_[row] = (c - a) * (by_e2 + b * by_e3);
      d_b_[row] = (c - b) * (by_e2 + a * by_e3);
    }
  }

  Structure structure_;
  std::vector<std::pair<int, int>> powers_;
  Vector<T> value_, d_a_, d_b_, exact_;
};

template <class T>
bool admissible(const Structure& s, const Vector<T>& p) {
  Eigen::Index c = 0;
  if (s.centroid == 1 && !(p[c++] > 0)) return false;
  for (int k = 0; k < s.of_3; ++k, c += 2)
    if (!(p[c] > 0 && p[c] < T(0.5) && p[c + 1] > 0)) return false;
  for (int k = 0; k < s.of_6; ++k, c += 3)
    if (!(p[c] > 0 && p[c + 1] > 0 && p[c] + p[c + 1] < 1 && p[c + 2] > 0)) return false;
  return true;
}

Vector<double> random_start(const Structure& s, std::mt19937_64& random) {
  const auto uniform = [&] { return static_cast<double>(random() >> 11) * 0x1p-53; };
  Vector<double> p(s.unknowns());
  Eigen::Index c = 0;
  const auto weight = [&](double nearest_edge) {
    return (0.5 + uniform()) / s.points() * (nearest_edge < 0.08 ? 0.5 : 1.0);
  };
  if (s.centroid == 1) p[c++] = weight(1);
  for (int k = 0; k < s.of_3; ++k, c += 2) {
    p[c] = 0.5 * (k + uniform()) / s.of_3;
    p[c + 1] = weight(std::min(p[c], 1 - 2 * p[c]));
  }
  for (int k = 0; k < s.of_6; ++k, c += 3) {
    double a = uniform(), b = uniform();
    if (a + b > 1) a = 1 - a, b = 1 - b;
    std::array<double, 3> sorted = {a, b, 1 - a - b};
    std::sort(sorted.begin(), sorted.end());
    p.segment<3>(c) << sorted[0], sorted[1], weight(sorted[0]);
  }
  return p;
}

/// Levenberg-Marquardt; true when it ends at a solution.
bool solve(MomentEquations<double>& equations, const Structure& s, Vector<double>& p) {
  Vector<double> r, trial_r;
  Matrix<double> J, trial_J;
  equations.residual(p, r, J);
  double damping = 1e-2, cost = r.squaredNorm();
  for (int step = 0; step < 150 && cost > 1e-24; ++step) {
    const Matrix<double> A = J.transpose() * J;
    const Vector<double> gradient = J.transpose() * r;
    bool accepted = false;
    for (int attempt = 0; attempt < 8 && !accepted; ++attempt) {
      Matrix<double> damped = A;
      damped.diagonal() += damping * A.diagonal() + Vector<double>::Constant(A.rows(), 1e-18);
      const Vector<double> trial = p - damped.ldlt().solve(gradient);
      equations.residual(trial, trial_r, trial_J);
      accepted = trial_r.squaredNorm() < cost;
      damping = accepted ? std::max(damping * 0.2, 1e-12) : damping * 4;
      if (accepted) {
        p = trial;
        r = trial_r;
        J = trial_J;
        cost = r.squaredNorm();
      }
    }
    if (!accepted || (step == 60 && cost > 1e-7)) break;
    if (step > 20 && step % 10 == 0 && cost > 1e-9 && !admissible(s, p)) break;
  }
  return cost < 1e-18 && admissible(s, p);
}

/// Newton's method with the shortest step where there are more unknowns than equations; true at 30 digits.
bool polish(const Structure& s, const Vector<double>& start, Vector<Quad>& p) {
  MomentEquations<Quad> equations(s);
  p = start.cast<Quad>();
  Vector<Quad> r;
  Matrix<Quad> J;
  for (int step = 0; step < 8; ++step) {
    equations.residual(p, r, J);
    p -= J.completeOrthogonalDecomposition().solve(r);
  }
  equations.residual(p, r, J);
  return r.norm() < Quad(1e-30) && admissible(s, p);
}

Vector<Quad> find_rule(const Structure& s) {
  MomentEquations<double> equations(s);
  std::mt19937_64 random(static_cast<std::uint64_t>(1000 * s.degree + s.centroid + 7));
  for (;;) {
    Vector<double> p = random_start(s, random);
    Vector<Quad> polished;
    if (solve(equations, s, p) && polish(s, p, polished)) return polished;
  }
}

void write_rule(std::ostream& out, const Structure& s, const Vector<Quad>& p) {
  out << "// " << s.points() << " points\ninline constexpr double triangle_degree_" << s.degree << "[] = {\n";
  Eigen::Index c = 0;
  const auto line = [&](int count) {
    out << "   ";
    for (int k = 0; k < count; ++k) out << ' ' << p[c++].str(25, std::ios_base::fmtflags(0)) << ',';
    out << '\n';
  };
  if (s.centroid == 1) line(1);
  for (int k = 0; k < s.of_3; ++k) line(2);
  for (int k = 0; k < s.of_6; ++k) line(3);
  out << "};\n";
}

void write_table(std::ostream& out) {
  out << "// SPDX-License-Identifier: BSD-3-Clause\n"
         "/// \\file\n"
         "/// Orbits of the symmetric triangle rules; written by tests/oracle/make_triangle_rules.cpp, 25 digits.\n"
         "#pragma once\n\n#include <array>\n#include <span>\n\nnamespace skinbem::detail {\n\n"
         "/// Parameters in this order: the centroid's weight; (a, weight) for each orbit of (a, a, 1-2a); (a, b, "
         "weight) for\n"
         "/// each orbit of (a, b, 1-a-b).\n"
         "struct TriangleOrbits {\n  int degree, centroid, of_3, of_6;\n  std::span<const double> parameters;\n};\n\n";
  for (const Structure& s : structures) {
    write_rule(out, s, find_rule(s));
    std::cerr << "degree " << s.degree << '\n';
  }
  out << "\ninline constexpr std::array<TriangleOrbits, " << std::size(structures) << "> triangle_orbits = {{\n";
  for (const Structure& s : structures)
    out << "    {" << s.degree << ", " << s.centroid << ", " << s.of_3 << ", " << s.of_6 << ", triangle_degree_"
        << s.degree << "},\n";
  out << "}};\n\n}  // namespace skinbem::detail\n";
}

}  // namespace

int main(int argc, char** argv) {
  if (argc != 2) {
    std::cerr << "usage: make_triangle_rules quadrature/triangle_rules_table.hpp\n";
    return 2;
  }
  skinbem::write_file_atomically(argv[1], write_table);
  return 0;
}
