// The text beside a drawing, in SVG: headings, rows, sentences and the legend.
#pragma once

#include <cstdio>
#include <string>

#include "node/tool/drawing/svg/svg_text.h"

namespace palpate {

/// Printf-formatted text of at most 511 characters.
template <typename... Values>
std::string formatted(const char* pattern, Values... values) {
  char text[512];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

/// Writes lines from a position downwards, none wider than `width`. [px]
class SvgTable {
 public:
  SvgTable(double x, double y, double width) : x_(x), y_(y), width_(width) {}

  void heading(const std::string& text);
  void row(const std::string& name, const std::string& value);
  void words(const std::string& text);
  void key(const char* colour, const std::string& label);
  void gap() { y_ += 8.0; }

  const std::string& svg() const { return svg_; }
  /// Where the next line would be written.
  double y() const { return y_; }

 private:
  /// As many lines as the text takes.
  void add_text(double indent, const std::string& text);

  double x_;
  double y_;
  double width_;
  std::string svg_;
};

}  // namespace palpate
