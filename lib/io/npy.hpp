// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Matrices as NumPy files (.npy), as specified in NumPy's `numpy.lib.format`.
#pragma once

#include <Eigen/Core>
#include <filesystem>

namespace skinbem {

/// Scalar type of the file; little-endian either way.
enum class NpyType { float64, float32 };

/// Writes `matrix` in C order, format 1.0, whole or not at all. Throws Error(numerical) when an entry is not finite, or
/// does not fit float32 where that is asked for; Error(io) when the file cannot be written.
void write_npy(const std::filesystem::path& path, const Eigen::Ref<const Eigen::MatrixXd>& matrix,
               NpyType type = NpyType::float64);

/// Reads a two-dimensional array of float32 or float64, of either byte order and either storage order, format 1.0 or
/// 2.0. Throws Error(bad_input) for any other content: another type or rank, a header out of order, a file shorter or
/// longer than its shape says, an entry that is not finite; Error(io) when the file cannot be read.
Eigen::MatrixXd read_npy(const std::filesystem::path& path);

}  // namespace skinbem
