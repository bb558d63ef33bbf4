// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/base/text.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <fstream>

#include <skinbem/base/error.hpp>

#include "files.hpp"

namespace skinbem {
namespace {

using testing::ElementsAre;

class TextFileOf : public testing::Test {
 protected:
  const std::filesystem::path& written(const std::string& text) {
    std::ofstream(path_, std::ios::binary) << text;
    return path_;
  }
  std::string refusal(const std::string& text) {
    try {
      TextFile file(written(text));
    } catch (const Error& error) {
      EXPECT_EQ(error.code(), ErrorCode::bad_input);
      return error.what();
    }
    return "read";
  }

 private:
  testing_support::TemporaryFolder folder_;
  std::filesystem::path path_ = folder_ / "a.txt";
};

TEST_F(TextFileOf, AnySystemHasTheSameLines) {
  for (const std::string text : {"a\n\nb", "a\n\nb\n", "a\r\n\r\nb\r\n", "a\r\rb\r",
                                 "\xEF\xBB\xBF"
                                 "a\r\n\rb"}) {
    EXPECT_THAT(TextFile(written(text)).lines(), ElementsAre("a", "", "b")) << text;
  }
  EXPECT_THAT(TextFile(written("")).lines(), testing::IsEmpty());
}

TEST_F(TextFileOf, BytesThatAreNoTextIsRefused) {
  using namespace std::string_literals;
  EXPECT_THAT(refusal("\xFF\xFEn\0a\0"s), testing::HasSubstr("a.txt:1: UTF-16 text"));
  EXPECT_THAT(refusal("name\nb\0\1"s), testing::HasSubstr("a.txt:2: binary data"));
  EXPECT_THAT(refusal("na\x1b[31mme\n"), testing::HasSubstr("a.txt:1: binary data"));
  EXPECT_EQ(refusal("\xC3\xA9\ta\v\n"), "read");
}

}  // namespace
}  // namespace skinbem
