// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Files are written whole or not at all.
#pragma once

#include <filesystem>
#include <functional>
#include <ostream>
#include <string>

namespace skinbem {

/// Calls `write` with a binary stream on a temporary file beside `path`, then renames it to `path`.
/// When `write` throws or the disk is full, the temporary is removed and an existing `path` is left as it was.
/// Throws Error(io) with the path and the system's reason.
void write_file_atomically(const std::filesystem::path& path, const std::function<void(std::ostream&)>& write);

/// The whole content of a file. Throws Error(io) when it cannot be opened or read.
std::string read_file(const std::filesystem::path& path);

}  // namespace skinbem
