// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/frame/compression.hpp>

#include <Eigen/Eigenvalues>
#include <algorithm>
#include <limits>
#include <numeric>
#include <utility>

#include <skinbem/base/error.hpp>

namespace skinbem::detail {
namespace {

/// Vertices a patch. Measured over 64 to 512 on the leg with 100 landmarks: fewer bytes than with any other.
constexpr Index kPatch = 128;
constexpr Index kPanelsOfPatch = kPatch / static_cast<Index>(kPanelWidth);
/// Share of the error that may come from leaving out directions; the rest is for the integers.
constexpr double kTruncationShare = 0.7;
/// Of the numbers in a patch of R: a basis and coordinates that are more do not pay for their second pass.
constexpr double kLargestShare = 0.75;

/// Splits the vertices of [begin, end) across their longest side until they are patches; all but the last are full.
void sort_into_patches(const Points& rest, std::uint32_t* begin, std::uint32_t* end) {
  const Index count = end - begin;
  if (count <= kPatch) return;
  Eigen::RowVector3d low = rest.row(*begin), high = low;
  for (const std::uint32_t* v = begin; v != end; ++v) {
    low = low.cwiseMin(rest.row(*v));
    high = high.cwiseMax(rest.row(*v));
  }
  Index axis = 0;
  (high - low).maxCoeff(&axis);
  std::uint32_t* middle = begin + (count + kPatch - 1) / kPatch / 2 * kPatch;
  std::nth_element(begin, middle, end, [&](std::uint32_t a, std::uint32_t b) {
    return std::pair(rest(a, axis), a) < std::pair(rest(b, axis), b);
  });
  sort_into_patches(rest, begin, middle);
  sort_into_patches(rest, middle, end);
}

/// max_i sum_k |E_ik| for an error of any number of vertices, rows node-major.
double error_factor_of_rows(const Eigen::MatrixXd& error) {
  double worst = 0;
  for (Index v = 0; 3 * v < error.rows(); ++v) {
    double sum = 0;
    for (Index k = 0; 3 * k < error.cols(); ++k) sum += error.block<3, 3>(3 * v, 3 * k).norm();
    worst = std::max(worst, sum);
  }
  return worst;
}

/// The fewest leading left singular vectors of A that leave an error factor of at most `error_factor`; none where they
/// are too many to be worth it.
Eigen::MatrixXd basis_of(const Eigen::MatrixXd& A, double error_factor) {
  const Eigen::SelfAdjointEigenSolver<Eigen::MatrixXd> eigen(A * A.transpose());
  const Eigen::MatrixXd U = eigen.eigenvectors().rowwise().reverse();  // largest first
  const Eigen::MatrixXd Z = U.transpose() * A;
  Index low = 0, high = std::min(A.rows(), A.cols());
  while (low < high) {
    const Index rank = (low + high) / 2;
    if (error_factor_of_rows(A - U.leftCols(rank) * Z.topRows(rank)) <= error_factor) {
      high = rank;
    } else {
      low = rank + 1;
    }
  }
  const bool pays = static_cast<double>(low * (A.rows() + A.cols())) < kLargestShare * static_cast<double>(A.size());
  return U.leftCols(pays ? low : 0);
}

/// Entries for a panel of a basis (96 by rank), of which coordinate j is number `first` + j: U Z is A (96 by #columns)
/// to within `error_factor`. As many leading columns as that takes also get their remainder. False where all of them
/// do not suffice, since Z itself is not exact enough.
bool fit_panel(const Eigen::MatrixXd& A, Eigen::MatrixXd U, const Eigen::MatrixXd& Z, Index first, double error_factor,
               std::vector<QuantisedEntry>& entries, double& achieved) {
  const Eigen::MatrixXd exact = U;
  const auto add = [&](Index j) { entries.push_back(quantise(static_cast<std::uint32_t>(first + j), U.col(j))); };
  for (Index j = 0; j < U.cols(); ++j) add(j);
  for (Index refined = 0;;) {
    const double worst = error_factor_of(A - (exact - U) * Z);
    if (worst <= error_factor || refined == U.cols()) {
      achieved = std::max(achieved, worst);
      return worst <= error_factor;
    }
    for (const Index until = std::min(U.cols(), refined + 4); refined < until; ++refined) add(refined);
  }
}

/// The basis panels of all patches for coordinates Z that are as they will be stored. False where Z is not exact
/// enough.
bool fit_basis(const Points& rest, const Eigen::MatrixXd& response, const std::vector<Eigen::MatrixXd>& bases,
               const Eigen::MatrixXd& Z, double error_factor, PackedPanels& packed) {
  packed = {};
  packed.vertices = static_cast<std::size_t>(rest.rows());
  packed.quantised = true;
  Index first = 0;
  for (std::size_t patch = 0; patch < bases.size(); ++patch) {
    const Eigen::MatrixXd& U = bases[patch];
    const Eigen::MatrixXd rows = Z.middleRows(first, U.cols());
    for (std::size_t p = 0; 32 * p < static_cast<std::size_t>(U.rows()) / 3; ++p) {
      const std::size_t panel = patch * kPanelsOfPatch + p;
      std::vector<QuantisedEntry> entries;
      Eigen::MatrixXd A = panel_of(response, panel);
      if (U.cols() == 0) {
        entries = quantise_panel(A, static_cast<std::size_t>(Z.rows()), error_factor, packed.error_factor);
      } else if (!fit_panel(A, panel_of(U, p), rows, first, error_factor, entries, packed.error_factor)) {
        return false;
      }
      append_panel(rest, panel, entries, packed);
    }
    first += U.cols();
  }
  return true;
}

}  // namespace

CompressedPanels compress(const Points& rest, const Eigen::MatrixXd& response, double error_factor) {
  CompressedPanels result;
  result.order.resize(static_cast<std::size_t>(rest.rows()));
  std::iota(result.order.begin(), result.order.end(), 0U);
  sort_into_patches(rest, result.order.data(), result.order.data() + result.order.size());
  Points sorted_rest(rest.rows(), 3);
  Eigen::MatrixXd R(response.rows(), response.cols());
  for (Index i = 0; i < rest.rows(); ++i) {
    const Index v = result.order[static_cast<std::size_t>(i)];
    sorted_rest.row(i) = rest.row(v);
    R.middleRows(3 * i, 3) = response.middleRows(3 * v, 3);
  }

  std::vector<Eigen::MatrixXd> bases;
  Index coordinates = 0;
  for (Index first = 0; first < R.rows(); first += 3 * kPatch) {
    bases.push_back(
        basis_of(R.middleRows(first, std::min(3 * kPatch, R.rows() - first)), kTruncationShare * error_factor));
    coordinates += bases.back().cols();
  }
  Eigen::MatrixXd Z = Eigen::MatrixXd::Zero((coordinates + 2) / 3 * 3, R.cols());
  for (Index first = 0, row = 0, patch = 0; first < R.rows(); ++patch) {
    const Eigen::MatrixXd& U = bases[static_cast<std::size_t>(patch)];
    Z.middleRows(row, U.cols()) = U.transpose() * R.middleRows(first, U.rows());
    first += U.rows();
    row += U.cols();
  }
  result.largest_row = coordinates == 0 ? 0 : Z.cwiseAbs().rowwise().sum().maxCoeff();

  // Half the error of Z again and again; with remainders of remainders it ends at the rounding of double.
  double allowed = std::numeric_limits<double>::infinity();
  for (;;) {
    Eigen::MatrixXd lost;
    result.coordinates = pack_int16(Points::Zero(Z.rows() / 3, 3), Z, allowed, &lost);
    if (fit_basis(sorted_rest, R, bases, Z - lost, error_factor, result.basis)) return result;
    if (result.coordinates.error_factor == 0)
      throw Error(ErrorCode::numerical, "frame: the error bound is below rounding");
    allowed = result.coordinates.error_factor / 2;
  }
}

}  // namespace skinbem::detail
