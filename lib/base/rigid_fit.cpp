// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/base/rigid_fit.hpp>

#include <Eigen/Eigenvalues>
#include <Eigen/SVD>
#include <cmath>

namespace skinbem {
namespace {

Vec3 centroid(const Eigen::Ref<const Points>& points) { return points.colwise().mean().transpose(); }

}  // namespace

RigidMotion fit_rigid(const Eigen::Ref<const Points>& from, const Eigen::Ref<const Points>& to) noexcept {
  const Vec3 from_centre = centroid(from);
  const Vec3 to_centre = centroid(to);
  Mat3 covariance = Mat3::Zero();
  for (Index i = 0; i < from.rows(); ++i) {
    covariance += (to.row(i).transpose() - to_centre) * (from.row(i) - from_centre.transpose());
  }
  const Eigen::JacobiSVD<Mat3> svd(covariance, Eigen::ComputeFullU | Eigen::ComputeFullV);
  const double sign = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1.0 : 1.0;
  const Mat3 rotation = svd.matrixU() * Vec3(1, 1, sign).asDiagonal() * svd.matrixV().transpose();
  return {rotation, to_centre - rotation * from_centre};
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
