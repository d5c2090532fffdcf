// Lines and fields of a text file, and where an error stands.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <optional>
#include <string>
#include <string_view>

#include "node/files/printable.h"

namespace palpate::csv {

inline bool is_blank(char c) { return c == ' ' || c == '\t'; }

inline std::string_view trim(std::string_view text) {
  while (!text.empty() && is_blank(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_blank(text.back())) text.remove_suffix(1);
  return text;
}

/// As it may be shown in an error: short and printable.
inline std::string shown(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string quoted(1, '\'');
  quoted.append(printable(text, kLongest)).push_back('\'');
  return quoted;
}

/// One line after the other, without their ends (LF or CRLF; CR where the text has no LF).
class TextLines {
 public:
  TextLines(std::string_view text, std::string_view name) : text_(text), name_(name) {
    constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
    if (text_.starts_with(kByteOrderMark)) text_.remove_prefix(kByteOrderMark.size());
    if (text_.find('\n') == std::string_view::npos) end_ = '\r';
  }

  bool next() {
    if (position_ >= text_.size()) return false;
    ++number_;
    const std::size_t end = std::min(text_.find(end_, position_), text_.size());
    line_ = text_.substr(position_, end - position_);
    position_ = end + 1;
    if (line_.ends_with('\r')) line_.remove_suffix(1);
    return true;
  }

  std::string_view line() const { return line_; }
  std::size_t number() const { return number_; }

  /// "FILE:LINE:COLUMN: why"; `at` points into line().
  std::string error(const char* at, const std::string& why) const {
    const std::ptrdiff_t column = at == nullptr || line_.data() == nullptr ? 0 : at - line_.data();
    return std::string(name_) + ":" + std::to_string(std::max<std::size_t>(number_, 1)) + ":" +
           std::to_string(column + 1) + ": " + why;
  }

 private:
  std::string_view text_;
  std::string_view name_;
  char end_ = '\n';
  std::size_t position_ = 0;
  std::size_t number_ = 0;
  std::string_view line_;
};

/// The whole field as a number, infinities and NaN included; a plus sign may stand before it, and a
/// comma for the point where that is told.
inline std::optional<double> number_of(std::string_view text, bool decimal_comma) {
  std::string with_point;
  if (decimal_comma) {
    with_point = text;
    if (const std::size_t comma = with_point.find(','); comma != std::string::npos) {
      with_point[comma] = '.';
    }
    text = with_point;
  }
  if (text.size() > 1 && text[0] == '+' && text[1] != '-') text.remove_prefix(1);
  double value = 0.0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (text.empty() || status != std::errc() || end != text.data() + text.size()) {
    return std::nullopt;
  }
  return value;
}

}  // namespace palpate::csv
