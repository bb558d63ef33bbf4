// SPDX-License-Identifier: BSD-3-Clause
/// \file
/// What the strict readers of text files share.
#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace skinbem {

/// Throws Error(bad_input) "name:line: ..." where the beginning of `text` is binary or UTF-16 data: garbage is best
/// recognised there, before a message about some odd word in it would mislead.
void require_text(std::string_view text, const std::string& name);

/// A text file as its lines (LF, CR LF or CR; a byte order mark is dropped), and errors that name the place.
class TextFile {
 public:
  /// Throws Error(io) when the file cannot be read, Error(bad_input) when it is no text.
  explicit TextFile(const std::filesystem::path& path);
  TextFile(const TextFile&) = delete;
  TextFile& operator=(const TextFile&) = delete;

  /// Lines without their ends; the views live as long as this object. `lines()[0]` is line 1 of the file.
  const std::vector<std::string_view>& lines() const { return lines_; }
  const std::string& text() const { return text_; }
  /// Throws Error(bad_input) "path:line: what"; `line` counts from 1, 0 means the file as a whole.
  [[noreturn]] void fail(std::size_t line, const std::string& what) const;

 private:
  std::string path_;
  std::string text_;
  std::vector<std::string_view> lines_;
};

/// Without blanks and tabs at both ends.
std::string_view trimmed(std::string_view text);
/// A piece of a file for use in a message: in single quotes, unprintable bytes as '?', shortened.
std::string in_quotes(std::string_view text);
/// The pieces between blanks and tabs.
std::vector<std::string_view> words(std::string_view text);
/// The pieces between separators: always one more than there are separators.
std::vector<std::string_view> split(std::string_view text, char separator);
/// The whole of `text` as a finite number, else nothing (no locale, no trailing characters, no inf or nan).
std::optional<double> parse_number(std::string_view text);
std::optional<std::int64_t> parse_integer(std::string_view text);

}  // namespace skinbem
