// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Files for tests: a folder that vanishes, and the reference data that may lie beside the checkout.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <cstdlib>
#include <filesystem>
#include <string>

namespace skinbem::testing_support {

namespace fs = std::filesystem;

/// An empty folder for the life of the object.
class TemporaryFolder {
 public:
  TemporaryFolder() {
    std::string name = (fs::temp_directory_path() / "skinbem-XXXXXX").string();
    path_ = mkdtemp(name.data());
  }
  ~TemporaryFolder() { fs::remove_all(path_); }
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  const fs::path& path() const { return path_; }
  fs::path operator/(const std::string& name) const { return path_ / name; }

 private:
  fs::path path_;
};

/// A file or folder of the shared reference data ($SKINBEM_DATA, else ../shared/data beside the checkout).
inline fs::path shared_data(const std::string& name) {
  const char* root = std::getenv("SKINBEM_DATA");
  return (root ? fs::path(root) : fs::path(SKINBEM_TEST_SOURCE_DIR) / "../shared/data") / name;
}

/// A file that the project ships itself.
inline fs::path project_file(const std::string& name) { return fs::path(SKINBEM_TEST_SOURCE_DIR) / name; }

}  // namespace skinbem::testing_support

/// Skips the running test, saying so, where the shared reference data is not beside the checkout.
#define SKINBEM_NEEDS_SHARED_DATA(name)                                        \
  if (!std::filesystem::exists(::skinbem::testing_support::shared_data(name))) \
  GTEST_SKIP() << "needs " << ::skinbem::testing_support::shared_data(name) << "; set SKINBEM_DATA"
