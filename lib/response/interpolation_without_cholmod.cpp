// SPDX-License-Identifier: BSD-3-Clause
// The library built with SKINBEM_WITH_CHOLMOD=OFF, free of CHOLMOD's licence: the one answer is how to get the other.
#include <skinbem/base/error.hpp>
#include <skinbem/response/interpolation.hpp>

namespace skinbem {

struct SkinInterpolation::Factor {};

SkinInterpolation::SkinInterpolation(const Points&, const TriangleMesh&, const Progress&) {
  throw Error(ErrorCode::usage,
              "interpolation: this skinbem was built without CHOLMOD; configure it with -DSKINBEM_WITH_CHOLMOD=ON");
}
SkinInterpolation::~SkinInterpolation() = default;
SkinInterpolation::SkinInterpolation(SkinInterpolation&&) noexcept = default;
SkinInterpolation& SkinInterpolation::operator=(SkinInterpolation&&) noexcept = default;
Eigen::MatrixXd SkinInterpolation::apply(const Eigen::MatrixXd&, const Progress&) const { return {}; }
double SkinInterpolation::largest_distance() const noexcept { return 0; }

}  // namespace skinbem
