// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// A folder that goes with its owner.
#pragma once

#include <stdlib.h>

#include <filesystem>
#include <string>

#include <skinbem/base/error.hpp>

namespace skinbem::bench {

class TemporaryFolder {
 public:
  /// Throws Error(io).
  TemporaryFolder() {
    std::string name = (std::filesystem::temp_directory_path() / "skinbem-XXXXXX").string();
    if (!mkdtemp(name.data())) throw Error(ErrorCode::io, name + ": cannot make the folder");
    path_ = name;
  }
  ~TemporaryFolder() {
    std::error_code ignored;
    std::filesystem::remove_all(path_, ignored);
  }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;

  const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

}  // namespace skinbem::bench
