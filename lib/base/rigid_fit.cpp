// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/base/rigid_fit.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cmath>

namespace skinbem {
namespace {

Vec3 centroid(const Eigen::Ref<const Points>& points) { return points.colwise().mean().transpose(); }

/// Matrix of cofactors: det(m) m^-T, defined for singular m too.
Mat3 cofactors(const Mat3& m) {
  Mat3 c;
  c.row(0) = m.row(1).cross(m.row(2));
  c.row(1) = m.row(2).cross(m.row(0));
  c.row(2) = m.row(0).cross(m.row(1));
  return c;
}

/// Largest singular value, by the trigonometric roots of the characteristic polynomial of m^T m.
double spectral_norm(const Mat3& m) {
  const Mat3 s = m.transpose() * m;
  const double mean = s.trace() / 3;
  const Mat3 deviator = s - mean * Mat3::Identity();
  const double spread = std::sqrt(deviator.squaredNorm() / 6);
  if (spread <= 1e-15 * mean) return std::sqrt(mean);
  const double cosine = std::clamp(deviator.determinant() / (2 * spread * spread * spread), -1.0, 1.0);
  return std::sqrt(mean + 2 * spread * std::cos(std::acos(cosine) / 3));
}

/// Orthogonal polar factor of a matrix with positive determinant: Newton's iteration X <- (g X + X^-T / g) / 2 with
/// Higham's (1986) Frobenius scaling g. Singular values all become 1; the singular vectors stay.
Mat3 polar_factor(Mat3 x) {
  constexpr int kMostSteps = 20;
  // Convergence is quadratic: a step this small leaves an error of its square.
  constexpr double kLastStep = 1e-8;
  for (int i = 0; i < kMostSteps; ++i) {
    const Mat3 cofactor = cofactors(x);
    const double determinant = x.row(0).dot(cofactor.row(0));
    const double scale = std::sqrt(std::sqrt(cofactor.squaredNorm() / x.squaredNorm()) / determinant);
    const Mat3 next = (0.5 * scale) * x + (0.5 / (scale * determinant)) * cofactor;
    const double step = (next - x).squaredNorm();
    x = next;
    if (step <= kLastStep * kLastStep) break;
  }
  return x;
}

Mat3 nearest_rotation_by_svd(const Mat3& covariance) {
  const Eigen::JacobiSVD<Mat3> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1.0 : 1.0;
  return svd.matrixU() * Vec3(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
}

/// `to` holds displacements of `from` where `relative`, else positions.
RigidMotion fit(const Eigen::Ref<const Points>& from, const Eigen::Ref<const Points>& to, bool relative) noexcept {
  const Vec3 from_centre = centroid(from);
  const Vec3 to_centre = relative ? Vec3(from_centre + centroid(to)) : centroid(to);
  Mat3 covariance = Mat3::Zero();
  for (Index i = 0; i < from.rows(); ++i) {
    const Vec3 source = from.row(i).transpose() - from_centre;
    const Vec3 target =
        relative ? Vec3((from.row(i) + to.row(i)).transpose() - to_centre) : Vec3(to.row(i).transpose() - to_centre);
    covariance += target * source.transpose();
  }
  const Mat3 rotation = nearest_rotation(covariance);
  return {rotation, to_centre - rotation * from_centre};
}

}  // namespace

// With singular values s1 >= s2 >= |s3| (s3 carries the sign of the determinant), M + cof(M) / s1 has the same singular
// vectors and the values s1 + s2 s3 / s1, s2 + s3, s2 + s3. None is negative, so its polar factor is the proper
// rotation of M, for planar (s3 = 0) and mirrored (s3 < 0) point sets alike; and it is singular only where s2 + s3 = 0,
// which is where the answer itself is not unique. Several times cheaper than the decomposition, which is left those
// cases.
Mat3 nearest_rotation(const Mat3& covariance) noexcept {
  const double largest = covariance.cwiseAbs().maxCoeff();
  if (!(largest > 0) || !std::isfinite(largest)) return Mat3::Identity();
  const Mat3 m = covariance / largest;
  const double s1 = spectral_norm(m);
  const Mat3 proper = m + cofactors(m) / s1;
  constexpr double kUnique = 1e-4;  // least (s2 + s3) / s1
  if (proper.determinant() < kUnique * kUnique * s1 * s1 * s1) return nearest_rotation_by_svd(m);
  return polar_factor(proper);
}

RigidMotion fit_rigid(const Eigen::Ref<const Points>& from, const Eigen::Ref<const Points>& to) noexcept {
  return fit(from, to, false);
}

RigidMotion fit_rigid_displacement(const Eigen::Ref<const Points>& from,
                                   const Eigen::Ref<const Points>& displacement) noexcept {
  return fit(from, displacement, true);
}

double collinear_measure(const Eigen::Ref<const Points>& points) noexcept {
  const Vec3 centre = centroid(points);
  Mat3 covariance = Mat3::Zero();
  for (Index i = 0; i < points.rows(); ++i) {
    const Vec3 d = points.row(i).transpose() - centre;
    covariance += d * d.transpose();
  }
  const Vec3 variances = Eigen::SelfAdjointEigenSolver<Mat3>(covariance, Eigen::EigenvaluesOnly).eigenvalues();
  return variances(2) > 0 ? std::sqrt(std::max(variances(1), 0.0) / variances(2)) : 0;
}

}  // namespace skinbem
