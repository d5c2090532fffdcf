#include "node/tool/drawing/svg/svg_text.h"

#include <cstddef>
#include <cstdint>

namespace palpate {
namespace {

struct Character {
  std::size_t bytes = 1;
  std::uint32_t code = 0;
  bool is_valid = false;  ///< UTF-8, and XML permits it
};

/// The first character of a text that has one.
Character first_of(std::string_view text) {
  const auto byte = [&](std::size_t i) { return static_cast<unsigned char>(text[i]); };
  const unsigned char lead = byte(0);
  const std::size_t bytes = lead < 0x80   ? 1
                            : lead < 0xC2 ? 0
                            : lead < 0xE0 ? 2
                            : lead < 0xF0 ? 3
                                          : 4;
  if (bytes == 0 || lead > 0xF4 || bytes > text.size()) return {};
  std::uint32_t code = bytes == 1 ? lead : lead & (0xFFU >> (bytes + 1));
  for (std::size_t i = 1; i < bytes; ++i) {
    if ((byte(i) & 0xC0U) != 0x80U) return {};
    code = code << 6U | (byte(i) & 0x3FU);
  }
  constexpr std::uint32_t kLeast[] = {0, 0, 0x80, 0x800, 0x10000};
  const bool is_surrogate = code >= 0xD800 && code < 0xE000;
  if (code < kLeast[bytes] || code > 0x10FFFF || is_surrogate) return {};
  return {bytes, code, code >= 0x20 && code != 0xFFFE && code != 0xFFFF};
}

/// In units of the font's size: of DejaVu Sans, the widest of the fonts that are usual.
double width_of(std::uint32_t code) {
  constexpr double kThin = 0.43;
  constexpr double kUsual = 0.64;
  constexpr double kBroad = 0.85;
  constexpr double kWide = 1.0;
  constexpr std::uint32_t kAscii = 0x80;
  constexpr std::uint32_t kLatin = 0x250;
  if (code >= kAscii) return code < kLatin ? kBroad : kWide;
  const auto is_of = [&](std::string_view characters) {
    return characters.find(static_cast<char>(code)) != std::string_view::npos;
  };
  if (is_of(" !'(),-./:;IJ[\\]fijlrt|")) return kThin;
  if (is_of("%@MWm")) return kWide;
  return (code >= 'A' && code <= 'Z') || is_of("#&+<=>^~w") ? kBroad : kUsual;
}

/// Bytes of the beginning that fits; at least one character.
std::size_t fitting(std::string_view text, double width_px, double font_px) {
  double width = 0.0;
  std::size_t end = 0;
  while (end < text.size()) {
    const Character next = first_of(text.substr(end));
    width += font_px * width_of(next.code);
    if (end > 0 && width > width_px) break;
    end += next.bytes;
  }
  return end;
}

}  // namespace

std::string escaped(std::string_view text) {
  std::string safe;
  while (!text.empty()) {
    const Character next = first_of(text);
    switch (next.is_valid ? next.code : std::uint32_t{'?'}) {
      case '<':
        safe += "&lt;";
        break;
      case '>':
        safe += "&gt;";
        break;
      case '&':
        safe += "&amp;";
        break;
      case '"':
        safe += "&quot;";
        break;
      default:
        safe += next.is_valid ? text.substr(0, next.bytes) : "?";
    }
    text.remove_prefix(next.bytes);
  }
  return safe;
}

double text_width_px(std::string_view text, double font_px) {
  double width = 0.0;
  while (!text.empty()) {
    const Character next = first_of(text);
    width += font_px * width_of(next.code);
    text.remove_prefix(next.bytes);
  }
  return width;
}

std::vector<std::string> lines_within(std::string_view text, double width_px, double font_px) {
  std::vector<std::string> lines;
  do {
    std::size_t end = fitting(text, width_px, font_px);
    if (end < text.size() && text[end] != ' ') {
      const std::size_t blank = text.substr(0, end).rfind(' ');
      if (blank != std::string_view::npos && blank > 0) end = blank;
    }
    lines.emplace_back(text.substr(0, end));
    text.remove_prefix(end < text.size() && text[end] == ' ' ? end + 1 : end);
  } while (!text.empty());
  return lines;
}

std::string end_within(std::string_view text, double width_px, double font_px) {
  constexpr std::string_view kDots = "...";
  if (text_width_px(text, font_px) <= width_px) return std::string(text);
  const double room_px = width_px - text_width_px(kDots, font_px);
  double over_px = text_width_px(text, font_px) - room_px;
  while (over_px > 0.0 && !text.empty()) {
    const Character next = first_of(text);
    over_px -= font_px * width_of(next.code);
    text.remove_prefix(next.bytes);
  }
  return std::string(kDots).append(text);
}

}  // namespace palpate
