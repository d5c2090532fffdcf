// Numbers of things in sentences.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

namespace palpate {

/// "1 patch", "2 patches". `more` is the word for any other number; empty = `one` with an s.
inline std::string counted(std::uint64_t count, std::string_view one, std::string_view more = {}) {
  std::string text = std::to_string(count) + " ";
  if (count == 1) return text.append(one);
  return more.empty() ? text.append(one).append("s") : text.append(more);
}

}  // namespace palpate
