#include "node/tool/drawing/svg/svg_table.h"

namespace palpate {
namespace {

constexpr double kFont = 12.0;  // as the documents have it [px]
constexpr double kLine = 16.0;
constexpr double kBetween = 2.0;  // more, between entries

}  // namespace

void SvgTable::heading(const std::string& text) {
  svg_ += formatted("<text x=\"%.1f\" y=\"%.1f\" font-size=\"15\" font-weight=\"bold\">", x_, y_) +
          escaped(text) + "</text>\n";
  y_ += 20.0;
}

void SvgTable::row(const std::string& name, const std::string& value) {
  svg_ += formatted("<text x=\"%.1f\" y=\"%.1f\" fill=\"#5b6470\">", x_, y_) + escaped(name) +
          "</text>";
  add_text(62.0, value);
  y_ += kBetween;
}

void SvgTable::words(const std::string& text) { add_text(0.0, text); }

void SvgTable::key(const char* colour, const std::string& label) {
  svg_ += formatted("<rect x=\"%.1f\" y=\"%.1f\" width=\"12\" height=\"4\" fill=\"%s\"/>\n", x_,
                    y_ - 6.0, colour);
  add_text(18.0, label);
  y_ += kBetween;
}

void SvgTable::add_text(double indent, const std::string& text) {
  for (const std::string& line : lines_within(text, width_ - indent, kFont)) {
    svg_ +=
        formatted("<text x=\"%.1f\" y=\"%.1f\">", x_ + indent, y_) + escaped(line) + "</text>\n";
    y_ += kLine;
  }
}

}  // namespace palpate
