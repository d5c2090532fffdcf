#pragma once

#include <string_view>

namespace palpate {

/// Without the characters `of` at its ends.
inline std::string_view trimmed(std::string_view text, std::string_view of = " \t") {
  const auto is_of = [of](char c) { return of.find(c) != std::string_view::npos; };
  while (!text.empty() && is_of(text.front())) text.remove_prefix(1);
  while (!text.empty() && is_of(text.back())) text.remove_suffix(1);
  return text;
}

}  // namespace palpate
