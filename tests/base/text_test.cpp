// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/base/text.hpp>

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include "text_reader.hpp"

namespace skinbem {
namespace {

using testing::ElementsAre;

TextFile opened(const std::filesystem::path& path) { return TextFile(path); }

class TextFileOf : public testing_support::TextReader<opened> {
 protected:
  TextFileOf() : TextReader("a.txt") {}
};

TEST_F(TextFileOf, AnySystemHasTheSameLines) {
  for (const std::string text : {"a\n\nb", "a\n\nb\n", "a\r\n\r\nb\r\n", "a\r\rb\r",
                                 "\xEF\xBB\xBF"
                                 "a\r\n\rb"}) {
    EXPECT_THAT(read(text).lines(), ElementsAre("a", "", "b")) << text;
  }
  EXPECT_THAT(read("").lines(), testing::IsEmpty());
}

TEST_F(TextFileOf, BytesThatAreNoTextIsRefused) {
  using namespace std::string_literals;
  EXPECT_THAT(error_of("\xFF\xFEn\0a\0"s), testing::HasSubstr("a.txt:1: UTF-16 text"));
  EXPECT_THAT(error_of("name\nb\0\1"s), testing::HasSubstr("a.txt:2: binary data"));
  EXPECT_THAT(error_of("na\x1b[31mme\n"), testing::HasSubstr("a.txt:1: binary data"));
  EXPECT_EQ(error_of("\xC3\xA9\ta\v\n"), "no error");
}

}  // namespace
}  // namespace skinbem
