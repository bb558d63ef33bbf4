// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// True block GMRES: all right-hand sides share one Krylov space.
#pragma once

#include <functional>

#include <skinbem/base/progress.hpp>
#include <skinbem/base/types.hpp>

namespace skinbem {

struct GmresOptions {
  double tolerance = 1e-4;  ///< largest |g - A y| / |g| over the columns
  int most_iterations = 100;
};

struct GmresSummary {
  int iterations = 0;   ///< products with A
  double residual = 0;  ///< largest over the columns of |g - A y| / |g|, computed at the end
};

/// out = operator times in.
using BlockOperator = std::function<void(const VectorBlock& in, VectorBlock& out)>;

/// Y with A Y = G, right preconditioned, GMRES over the sum of the columns' Krylov spaces (Saad, Iterative Methods for
/// Sparse Linear Systems, 2nd ed., 6.12). A new block's directions that the space already has are dropped, so that
/// columns that depend on each other or have converged do no harm. Restarts on the true residual where the recursive
/// one was too hopeful. Returns what it reached, met or not: look at the summary. The same bits for any number of
/// threads if the operators promise it.
///
/// A and the preconditioner may round to single precision, the basis may not: the response is made of differences of
/// solutions, and with a basis in single precision it erred by 2.5e-4 where this one errs by 4e-6 (leg of 2,000
/// vertices).
VectorBlock block_gmres(const BlockOperator& A, const BlockOperator& preconditioner, VectorBlock G,
                        const GmresOptions& options, GmresSummary& summary, const Progress& progress = {});

/// V^T W, summed in an order that does not depend on the threads.
Eigen::MatrixXd inner_products(const VectorBlock& V, const VectorBlock& W);
/// W += V S.
void add_product(const VectorBlock& V, const RowMajorMatrix& S, VectorBlock& W);

}  // namespace skinbem
