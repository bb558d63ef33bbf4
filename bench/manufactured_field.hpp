// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A problem whose solution is known: a point load in the endless material outside the body.
///
/// Kelvin's solution is an elastic field in the body, free of forces there. Its exact tractions on the mesh's own
/// triangles are prescribed: the body is the polyhedron, so that its shape adds nothing to the error.
/// What comes out is compared with the exact displacements at the vertices, up to a rigid motion, which tractions leave
/// open.
#pragma once

#include "measured_response.hpp"

namespace skinbem::bench {

struct PointLoad {
  Vec3 place, load;
  double poisson;  ///< shear modulus 1

  /// N by 3, at the vertices.
  Points displacements(const TriangleMesh& skin) const;
  /// On a plane through x.
  Vec3 traction(const Vec3& x, const Vec3& normal) const;
};

/// Solves the problem by either method in a process of its own. As measure_response; besides: rms_error and max_error
/// of the displacement, relative to its root mean square and its largest value without its rigid part; and the seconds
/// "load" for G t, which are no part of the total: every vertex meets every triangle.
nlohmann::json measure_manufactured(const TriangleMesh& skin, const PointLoad& field, const ResponseCase& c,
                                    const ChildLimits& limits);

/// Errors of the displacement `u` against `exact`, both 3N by any number of columns, relative to the root mean square
/// and the largest entry of `exact`: rms_error, max_error.
nlohmann::json errors_of(const Eigen::MatrixXd& u, const Eigen::MatrixXd& exact);

}  // namespace skinbem::bench
