#include "node/csv/text_encoding.h"

#include <cstdint>

#include "node/files/recording.h"

namespace palpate::csv {
namespace {

void append_utf8(std::uint32_t point, std::string& text) {
  if (point < 0x80) {
    text += static_cast<char>(point);
    return;
  }
  const int following = point < 0x800 ? 1 : point < 0x10000 ? 2 : 3;
  constexpr std::uint32_t kLead[] = {0, 0xC0, 0xE0, 0xF0};
  text += static_cast<char>(kLead[following] | point >> (6 * following));
  for (int shift = 6 * (following - 1); shift >= 0; shift -= 6) {
    text += static_cast<char>(0x80 | (point >> shift & 0x3F));
  }
}

}  // namespace

std::optional<std::string> utf8_of_utf16(std::string_view text) {
  const bool is_little = text.starts_with("\xFF\xFE");
  if (!is_little && !text.starts_with("\xFE\xFF")) return std::nullopt;
  const auto unit = [&](std::size_t at) {
    const auto first = static_cast<unsigned char>(text[at]);
    const auto second = static_cast<unsigned char>(text[at + 1]);
    return static_cast<std::uint32_t>(is_little ? second << 8 | first : first << 8 | second);
  };
  std::string result;
  result.reserve(text.size() / 2);
  for (std::size_t at = 2; at + 1 < text.size(); at += 2) {
    std::uint32_t point = unit(at);
    const bool is_high = point >= 0xD800 && point < 0xDC00;
    if (is_high && at + 3 < text.size()) {
      const std::uint32_t low = unit(at + 2);
      if (low >= 0xDC00 && low < 0xE000) {
        point = 0x10000 + ((point - 0xD800) << 10) + (low - 0xDC00);
        at += 2;
      }
    }
    const bool is_half = point >= 0xD800 && point < 0xE000;
    append_utf8(is_half ? 0xFFFD : point, result);
  }
  return result;
}

std::optional<std::string> no_text_because(std::string_view bytes) {
  if (bytes.starts_with("\x1F\x8B")) {
    return "is packed by gzip: unpack it, as in gunzip -c FILE | palpate fit -";
  }
  if (bytes.starts_with("PK\x03\x04")) {
    return "is a zip archive, as spreadsheets (.xlsx, .ods) are: save the sheet as CSV";
  }
  if (bytes.starts_with("\xD0\xCF\x11\xE0")) return "is an old Excel file: save the sheet as CSV";
  if (bytes.starts_with(kRecordingMagic) || bytes.starts_with(kFormerRecordingMagic)) {
    return "is a recording of palpate, no table of points: palpate replay FILE publishes it to a "
           "running palpate-node";
  }
  if (bytes.starts_with("%PDF-")) return "is a PDF: export the points as text";
  return std::nullopt;
}

}  // namespace palpate::csv
