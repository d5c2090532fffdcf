// Makes untrusted strings safe to print. All code that prints them to a terminal or a log uses
// this.
#pragma once

#include <cstddef>
#include <string>
#include <string_view>

namespace palpate {

/// Keeps printable ASCII and writes every other byte as \xNN, so that no terminal control code gets
/// through. Shows at most `most` bytes of the text, then "...".
inline std::string printable(std::string_view text, std::size_t most = 200) {
  constexpr std::string_view kDigits = "0123456789abcdef";
  std::string shown;
  for (const char c : text.substr(0, most)) {
    if (c >= ' ' && c <= '~') {
      shown += c;
      continue;
    }
    const auto byte = static_cast<unsigned char>(c);
    shown += {'\\', 'x', kDigits[byte >> 4U], kDigits[byte & 0xFU]};
  }
  return text.size() > most ? shown + "..." : shown;
}

}  // namespace palpate
