// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A sequence of files, a frame each, in a folder of its own that is replaced as a whole.
#pragma once

#include <filesystem>
#include <functional>
#include <string>
#include <string_view>

namespace skinbem {

/// Calls `write` with an empty temporary folder beside `folder` and then puts it in place of `folder`. When `write`
/// throws, the temporary is removed and an existing sequence stays as it was. A folder that holds anything but files
/// named by frame_file with this extension is not a sequence and is never replaced: Error(io).
void write_frame_folder(const std::filesystem::path& folder, std::string_view extension,
                        const std::function<void(const std::filesystem::path&)>& write);

/// `part_000042.extension`: names sort as the frames do.
std::string frame_file(std::string_view part, std::ptrdiff_t frame, std::string_view extension);

}  // namespace skinbem
