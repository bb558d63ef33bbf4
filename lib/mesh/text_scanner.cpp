// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/mesh/text_scanner.hpp>

#include <charconv>
#include <cmath>
#include <cstdlib>

#include <skinbem/base/error.hpp>

namespace skinbem {
namespace {

bool is_blank(char c) { return c == ' ' || c == '\t' || c == '\v' || c == '\f'; }
bool is_newline(char c) { return c == '\n' || c == '\r'; }

/// Behind the line break at `p`.
const char* after_newline(const char* p, const char* end) {
  const bool two = *p == '\r' && p + 1 < end && p[1] == '\n';
  return p + (two ? 2 : 1);
}

}  // namespace

void fail_at_line(const std::string& name, std::int64_t line, const std::string& message) {
  throw Error(ErrorCode::bad_input, name + ":" + std::to_string(line) + ": " + message);
}

void fail_at_byte(const std::string& name, std::size_t offset, const std::string& message) {
  throw Error(ErrorCode::bad_input, name + ": byte " + std::to_string(offset) + ": " + message);
}

bool parse_number(std::string_view word, double& value) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  if (stop != end || word.empty()) return false;
  if (error == std::errc()) return true;
  if (error != std::errc::result_out_of_range) return false;
  value = std::strtod(std::string(word).c_str(), nullptr);  // from_chars does not tell tiny from huge
  return std::abs(value) < 1;
}

bool parse_integer(std::string_view word, std::int64_t& value) {
  if (word.starts_with('+') && !word.starts_with("+-")) word.remove_prefix(1);
  const char* end = word.data() + word.size();
  const auto [stop, error] = std::from_chars(word.data(), end, value);
  return !word.empty() && stop == end && error == std::errc();
}

TextScanner::TextScanner(std::string_view text, std::string name, Syntax syntax)
    : name_(std::move(name)), syntax_(syntax), line_(syntax.first_line), next_line_number_(syntax.first_line) {
  if (text.empty()) throw Error(ErrorCode::bad_input, name_ + ": the file is empty, nothing to read");
  require_text(text, name_);
  if (text.starts_with("\xEF\xBB\xBF")) text.remove_prefix(3);
  next_ = text.data();
  end_ = text.data() + text.size();
  cursor_ = line_end_ = next_;
}

bool TextScanner::next_line() {
  while (next_ < end_) {
    line_ = next_line_number_++;
    cursor_ = next_;
    const char* comment = nullptr;
    const char* p = cursor_;
    for (; p < end_ && !is_newline(*p); ++p) {
      if (*p == syntax_.comment && !comment && syntax_.comment != '\0') comment = p;
      if (syntax_.continuation && !comment && *p == '\\' && p + 1 < end_ && is_newline(p[1])) {
        p = after_newline(p + 1, end_) - 1;
        ++next_line_number_;
      }
    }
    line_end_ = comment ? comment : p;
    next_ = p < end_ ? after_newline(p, end_) : end_;
    if (more()) return true;
  }
  cursor_ = line_end_ = end_;
  return false;
}

void TextScanner::skip_blanks() {
  while (cursor_ < line_end_ && (is_blank(*cursor_) || is_newline(*cursor_) ||
                                 (*cursor_ == '\\' && cursor_ + 1 < line_end_ && is_newline(cursor_[1])))) {
    ++cursor_;
  }
}

bool TextScanner::more() {
  skip_blanks();
  return cursor_ < line_end_;
}

std::string_view TextScanner::word(const char* what) {
  if (!more()) fail(std::string("the line ends where ") + what + " was expected, complete it");
  const char* start = cursor_;
  while (cursor_ < line_end_ && !is_blank(*cursor_) && !is_newline(*cursor_) &&
         !(*cursor_ == '\\' && cursor_ + 1 < line_end_ && is_newline(cursor_[1]))) {
    ++cursor_;
  }
  return {start, static_cast<std::size_t>(cursor_ - start)};
}

double TextScanner::any_number(const char* what) {
  const std::string_view text = word(what);
  double value = 0;
  if (!parse_number(text, value)) {
    fail(in_quotes(text) + " is not a number in the range of a double where " + what + " was expected, correct it");
  }
  return value;
}

double TextScanner::number(const char* what) {
  const char* before = cursor_;
  const double value = any_number(what);
  if (!std::isfinite(value)) {
    cursor_ = before;
    fail(in_quotes(word(what)) + " is not finite where " + what + " was expected, correct or remove it");
  }
  return value;
}

std::int64_t TextScanner::integer(const char* what) {
  const std::string_view text = word(what);
  std::int64_t value = 0;
  if (!parse_integer(text, value))
    fail(in_quotes(text) + " is not a whole number where " + what + " was expected, correct it");
  return value;
}

void TextScanner::end_of_line() {
  if (more()) fail("unexpected " + in_quotes(word("nothing")) + " at the end of the line, remove it");
}

}  // namespace skinbem
