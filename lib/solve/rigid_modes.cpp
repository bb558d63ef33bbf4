// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/solve/rigid_modes.hpp>

#include <Eigen/Geometry>
#include <Eigen/QR>

#include <skinbem/base/error.hpp>

namespace skinbem {

Eigen::MatrixXd rigid_modes(const Points& points) {
  const Vec3 centroid = points.colwise().mean().transpose();
  const double size = (points.rowwise() - centroid.transpose()).cwiseAbs().maxCoeff();
  Eigen::MatrixXd modes(3 * points.rows(), 6);
  for (Index i = 0; i < points.rows(); ++i) {
    const Vec3 x = (points.row(i).transpose() - centroid) / size;
    modes.block<3, 3>(3 * i, 0).setIdentity();
    for (int k = 0; k < 3; ++k) modes.block<3, 1>(3 * i, 3 + k) = Vec3::Unit(k).cross(x);
  }
  const Eigen::HouseholderQR<Eigen::MatrixXd> qr(modes);
  const Eigen::VectorXd r = qr.matrixQR().diagonal().head(6).cwiseAbs();
  if (!(r.minCoeff() > 1e-10 * r.maxCoeff())) {
    throw Error(ErrorCode::bad_input, "the vertices lie on a line: no body can be made of them");
  }
  return qr.householderQ() * Eigen::MatrixXd::Identity(modes.rows(), 6);
}

}  // namespace skinbem
