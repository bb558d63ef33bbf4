// SPDX-License-Identifier: BSD-3-Clause
#include <skinbem/base/text.hpp>

#include <algorithm>
#include <charconv>
#include <cmath>

#include <skinbem/base/atomic_file.hpp>
#include <skinbem/base/error.hpp>

namespace skinbem {
namespace {

constexpr std::string_view blanks = " \t";

/// std::from_chars knows no plus sign; files do.
std::string_view without_plus(std::string_view text) {
  const bool plus = text.size() > 1 && text[0] == '+' && text[1] != '-' && text[1] != '+';
  return plus ? text.substr(1) : text;
}

template <class Number>
std::optional<Number> parse(std::string_view text) {
  text = without_plus(text);
  Number value{};
  const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (error != std::errc() || end != text.data() + text.size()) return std::nullopt;
  return value;
}

}  // namespace

void require_text(std::string_view text, const std::string& name) {
  if (text.starts_with("\xFF\xFE") || text.starts_with("\xFE\xFF")) {
    throw Error(ErrorCode::bad_input, name + ":1: UTF-16 text, save it as ASCII or UTF-8");
  }
  const std::string_view head = text.substr(0, 4096);
  const auto odd = std::find_if(head.begin(), head.end(), [](char c) {
    const auto byte = static_cast<unsigned char>(c);
    return (byte < 0x20 && !(c >= '\t' && c <= '\r')) || byte == 0x7F;
  });
  if (odd != head.end()) {
    const auto line = 1 + std::count(head.begin(), odd, '\n');
    throw Error(ErrorCode::bad_input, name + ":" + std::to_string(line) +
                                          ": binary data where text was expected, check the file and its extension");
  }
}

TextFile::TextFile(const std::filesystem::path& path) : path_(path.string()), text_(read_file(path)) {
  require_text(text_, path_);
  if (text_.starts_with("\xef\xbb\xbf")) text_.erase(0, 3);
  for (std::size_t i = 0; i < text_.size(); ++i) {  // a lone CR ends a line too
    if (text_[i] == '\r' && text_.substr(i + 1, 1) != "\n") text_[i] = '\n';
  }
  lines_ = split(text_, '\n');
  if (lines_.back().empty()) lines_.pop_back();
  for (std::string_view& line : lines_) {
    if (line.ends_with('\r')) line.remove_suffix(1);
  }
}

void TextFile::fail(std::size_t line, const std::string& what) const {
  const std::string place = line == 0 ? path_ : path_ + ":" + std::to_string(line);
  throw Error(ErrorCode::bad_input, place + ": " + what);
}

std::string_view trimmed(std::string_view text) {
  const std::size_t first = text.find_first_not_of(blanks);
  if (first == std::string_view::npos) return {};
  return text.substr(first, text.find_last_not_of(blanks) - first + 1);
}

std::string in_quotes(std::string_view text) {
  constexpr std::size_t longest = 40;
  std::string result = "'";
  for (const char c : text.substr(0, longest)) result += (c >= 0x20 && c < 0x7F) ? c : '?';
  return result + (text.size() > longest ? "...'" : "'");
}

std::vector<std::string_view> words(std::string_view text) {
  std::vector<std::string_view> result;
  for (std::size_t end = 0;;) {
    const std::size_t begin = text.find_first_not_of(blanks, end);
    if (begin == std::string_view::npos) return result;
    end = std::min(text.find_first_of(blanks, begin), text.size());
    result.push_back(text.substr(begin, end - begin));
  }
}

std::vector<std::string_view> split(std::string_view text, char separator) {
  std::vector<std::string_view> result;
  for (;;) {
    const std::size_t end = text.find(separator);
    result.push_back(text.substr(0, end));
    if (end == std::string_view::npos) return result;
    text.remove_prefix(end + 1);
  }
}

std::optional<double> parse_number(std::string_view text) {
  const std::optional<double> value = parse<double>(text);
  return value && std::isfinite(*value) ? value : std::nullopt;
}

std::optional<std::int64_t> parse_integer(std::string_view text) { return parse<std::int64_t>(text); }

}  // namespace skinbem
