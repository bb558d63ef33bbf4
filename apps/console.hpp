// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What goes to the terminal beside results: messages and progress, on stderr.
#pragma once

#include <filesystem>
#include <string>
#include <vector>

#include <skinbem/base/progress.hpp>

/// Prints `skinbem: warning: message`.
void warn(const std::string& message);

/// A line that shows how far the work is, where stderr is a terminal; nothing elsewhere. At most ten times a second.
skinbem::Progress terminal_progress();
/// Wipes that line.
void end_progress();

/// Throws Error(usage) when `output` has no name.
void require_name(const std::filesystem::path& output);
/// What a run writes is checked before hours are spent on what it should hold. Throws Error(io) when `output` cannot be
/// created, Error(usage) when it has no name or is one of the `inputs`, which it would replace.
void require_writable(const std::filesystem::path& output, const std::vector<std::string>& inputs);
/// The same for an output that is no folder.
void require_writable_file(const std::filesystem::path& output, const std::vector<std::string>& inputs);
