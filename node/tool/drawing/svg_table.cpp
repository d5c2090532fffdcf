#include "node/tool/drawing/svg_table.h"

namespace palpate {

std::string escaped(const std::string& text) {
  std::string safe;
  for (const char c : text) {
    switch (c) {
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
        // XML does not permit control characters.
        safe += static_cast<unsigned char>(c) < ' ' ? '?' : c;
    }
  }
  return safe;
}

void SvgTable::heading(const std::string& text) {
  svg_ += formatted("<text x=\"%.1f\" y=\"%.1f\" font-size=\"15\" font-weight=\"bold\">", x_, y_) +
          escaped(text) + "</text>\n";
  y_ += 20.0;
}

void SvgTable::row(const std::string& name, const std::string& value) {
  svg_ += formatted("<text x=\"%.1f\" y=\"%.1f\" fill=\"#5b6470\">", x_, y_) + escaped(name) +
          "</text>";
  add_text(62.0, value);
  y_ += 18.0;
}

void SvgTable::words(const std::string& text) {
  constexpr std::size_t kLineLength = 44;
  std::string rest = text;
  while (!rest.empty()) {
    std::size_t cut = rest.size() <= kLineLength ? rest.size() : rest.rfind(' ', kLineLength);
    if (cut == std::string::npos) cut = kLineLength;
    add_text(0.0, rest.substr(0, cut));
    rest.erase(0, cut < rest.size() && rest[cut] == ' ' ? cut + 1 : cut);
    y_ += 16.0;
  }
}

void SvgTable::key(const char* colour, const std::string& label) {
  svg_ += formatted("<rect x=\"%.1f\" y=\"%.1f\" width=\"12\" height=\"4\" fill=\"%s\"/>\n", x_,
                    y_ - 6.0, colour);
  add_text(18.0, label);
  y_ += 18.0;
}

void SvgTable::add_text(double indent, const std::string& text) {
  svg_ += formatted("<text x=\"%.1f\" y=\"%.1f\">", x_ + indent, y_) + escaped(text) + "</text>\n";
}

}  // namespace palpate
