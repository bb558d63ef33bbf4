// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Tests of readers of text files.
#pragma once

#include <gtest/gtest.h>

#include <fstream>
#include <string>

#include "files.hpp"
#include "refusal.hpp"

namespace skinbem::testing_support {

/// Texts as files of one name, read by `read_file`.
template <auto read_file>
class TextReader : public ::testing::Test {
 protected:
  explicit TextReader(const std::string& name) : path_(folder_ / name) {}

  auto read(const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    return read_file(path_);
  }
  std::string error_of(const std::string& text) {
    return refusal([&] { read(text); });
  }
  /// Of `text` with the first `from` replaced by `to`.
  std::string error_of(std::string text, const std::string& from, const std::string& to) {
    return error_of(text.replace(text.find(from), from.size(), to));
  }

 private:
  TemporaryFolder folder_;
  std::filesystem::path path_;
};

}  // namespace skinbem::testing_support
