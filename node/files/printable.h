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

/// A file's name as a terminal may show it: as it is, letters of any language too, but without the
/// characters that a terminal obeys or that end a line.
inline std::string printable_path(std::string_view path) {
  std::string shown;
  for (std::size_t i = 0; i < path.size(); ++i) {
    const auto byte = static_cast<unsigned char>(path[i]);
    // UTF-8 has the terminal's second set of controls at U+0080 to U+009F.
    const bool begins_control =
        byte == 0xC2 && i + 1 < path.size() && static_cast<unsigned char>(path[i + 1]) < 0xA0;
    const bool is_plain = byte >= 0x20 && byte != 0x7F && !begins_control;
    shown += is_plain ? std::string(1, path[i]) : printable(path.substr(i, 1));
    if (begins_control) shown += printable(path.substr(++i, 1));
  }
  return shown;
}

}  // namespace palpate
