// Lines and fields of a text file, and where an error stands.
#pragma once

#include <algorithm>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <type_traits>

#include "node/files/printable.h"
#include "node/files/trimmed.h"

namespace palpate::csv {

inline bool is_blank(char c) { return c == ' ' || c == '\t'; }

/// As it may be shown in an error: short and printable.
inline std::string shown(std::string_view text) {
  constexpr std::size_t kLongest = 40;
  std::string quoted(1, '\'');
  quoted.append(printable(text, kLongest)).push_back('\'');
  return quoted;
}

/// Of a line of names that comes a second time where patches have numbers.
inline constexpr std::string_view kNamesAgain =
    "the names of the columns come again: are these two files in one? Their patches share numbers: "
    "split the file, or number the patches of the second on";

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

  /// A line that is read already.
  struct Place {
    std::size_t number = 0;
    std::string_view line;
  };
  Place place() const { return {number_, line_}; }

  /// "FILE:LINE:COLUMN: why"; `at` points into line().
  std::string error(const char* at, const std::string& why) const {
    return error(place(), at, why);
  }

  /// The same of an earlier line, which `at` points into.
  std::string error(const Place& place, const char* at, const std::string& why) const {
    const char* begin = place.line.data();
    const std::ptrdiff_t column = at == nullptr || begin == nullptr ? 0 : at - begin;
    return std::string(name_) + ":" + std::to_string(std::max<std::size_t>(place.number, 1)) + ":" +
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

/// from_chars knows no plus sign; people write it. A second sign is left for it to refuse.
inline std::string_view without_plus(std::string_view text) {
  const bool has_plus = text.size() > 1 && text[0] == '+' && text[1] != '-';
  return text.substr(has_plus ? 1 : 0);
}

/// The whole field as a number, infinities and NaN included; a plus sign may stand before it, a
/// comma for the point where that is told, and Fortran's D for the E of an exponent.
inline std::optional<double> number_of(std::string_view text, bool decimal_comma) {
  std::string rewritten;
  if (const std::size_t comma = text.find(','); decimal_comma && comma != std::string_view::npos) {
    rewritten = text;
    rewritten[comma] = '.';
    text = rewritten;
  }
  text = without_plus(text);
  double value = 0.0;
  auto parsed = std::from_chars(text.data(), text.data() + text.size(), value);
  const auto stopped_at = static_cast<std::size_t>(parsed.ptr - text.data());
  if (parsed.ec == std::errc() && stopped_at < text.size() &&
      (text[stopped_at] == 'D' || text[stopped_at] == 'd')) {
    std::string with_e(text);
    with_e[stopped_at] = 'e';
    rewritten.swap(with_e);
    text = rewritten;
    parsed = std::from_chars(text.data(), text.data() + text.size(), value);
  }
  if (text.empty() || parsed.ec != std::errc() || parsed.ptr != text.data() + text.size()) {
    return std::nullopt;
  }
  return value;
}

/// The whole field as a whole number that its type can hold. "3.0" and "3.0e+00" are whole too:
/// numpy and pandas write columns of whole numbers so.
template <typename Integer>
std::optional<Integer> whole_of(std::string_view text) {
  text = without_plus(text);
  Integer value = 0;
  const auto [end, status] = std::from_chars(text.data(), text.data() + text.size(), value);
  if (status == std::errc() && end == text.data() + text.size()) return value;
  const std::optional<double> number = number_of(text, false);
  // A power of two, which a double holds exactly: the first number that the type does not hold.
  const double beyond = std::ldexp(1.0, std::numeric_limits<Integer>::digits);
  const double lowest = std::is_signed_v<Integer> ? -beyond : 0.0;
  if (!number || !(*number >= lowest && *number < beyond) || std::trunc(*number) != *number) {
    return std::nullopt;
  }
  return static_cast<Integer>(*number);
}

/// Why whole_of() returns none.
template <typename Integer>
std::string_view why_no_whole(std::string_view text) {
  const std::optional<double> number = number_of(text, false);
  const bool is_whole = number && std::trunc(*number) == *number && std::isfinite(*number);
  if (is_whole && (std::is_signed_v<Integer> || *number >= 0.0)) return "out of range";
  return std::is_signed_v<Integer> ? "not a whole number" : "not a whole number >= 0";
}

}  // namespace palpate::csv
