// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// Strict reading of line-oriented text held in memory. Every failure is an Error(bad_input) that begins with
/// `file:line:`.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include <skinbem/base/text.hpp>

namespace skinbem {

/// Throws Error(bad_input, "name:line: message").
[[noreturn]] void fail_at_line(const std::string& name, std::int64_t line, const std::string& message);
/// Throws Error(bad_input, "name: byte OFFSET: message").
[[noreturn]] void fail_at_byte(const std::string& name, std::size_t offset, const std::string& message);

/// Walks over the words of the non-blank lines of a text. Lines end with LF, CR LF or CR; a UTF-8 byte order mark is
/// skipped. The text must outlive the scanner.
class TextScanner {
 public:
  struct Syntax {
    char comment = '\0';          ///< starts a comment that reaches to the end of the line; none when '\0'
    bool continuation = false;    ///< a backslash at the end of a line, not of a comment, joins the next line to it
    std::int64_t first_line = 1;  ///< number of the text's first line
  };

  /// Throws when the text is empty or its beginning is binary or UTF-16 data.
  TextScanner(std::string_view text, std::string name, Syntax syntax);

  /// Moves to the next line with a word on it; false at the end of the text.
  bool next_line();
  /// Whether the line has another word.
  bool more();
  /// The next word of the line; fails when there is none. `what` says in messages what is read.
  std::string_view word(const char* what);
  /// The next word as a number in decimal notation, whole and finite.
  double number(const char* what);
  /// The same, but NaN and infinities pass.
  double any_number(const char* what);
  /// The next word as a whole number.
  std::int64_t integer(const char* what);
  /// Fails when words are left on the line.
  void end_of_line();

  [[noreturn]] void fail(const std::string& message) const { fail_at_line(name_, line_, message); }
  const std::string& name() const { return name_; }
  /// Number of the current line, from 1; of the last one after the end.
  std::int64_t line() const { return line_; }

 private:
  void skip_blanks();

  std::string name_;
  Syntax syntax_;
  const char* cursor_;    // in the current line
  const char* line_end_;  // behind its last byte, comment cut off
  const char* next_;      // start of the next line
  const char* end_;       // of the text
  std::int64_t line_;
  std::int64_t next_line_number_;
};

/// The whole of `word` as a decimal number into `value`; false when anything else is in it or it overflows. A leading
/// plus sign passes, so do "nan" and "inf"; numbers too small for a double become the nearest one.
bool parse_number(std::string_view word, double& value);
/// The whole of `word` as a decimal whole number into `value`; false when anything else is in it or it overflows.
bool parse_integer(std::string_view word, std::int64_t& value);

}  // namespace skinbem
