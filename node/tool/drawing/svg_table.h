// Text beside a drawing, in SVG: headings, rows, sentences and the meaning of colours.
#pragma once

#include <cstdio>
#include <string>

namespace palpate {

/// What printf makes of the values, up to 511 characters.
template <typename... Values>
std::string formatted(const char* pattern, Values... values) {
  char text[512];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

/// Text as it may stand in markup.
std::string escaped(const std::string& text);

/// Lines from a place downwards. [px]
class SvgTable {
 public:
  SvgTable(double x, double y) : x_(x), y_(y) {}

  void heading(const std::string& text);
  void row(const std::string& name, const std::string& value);
  /// In lines that fit.
  void words(const std::string& text);
  void key(const char* colour, const std::string& label);
  void gap() { y_ += 8.0; }

  const std::string& svg() const { return svg_; }

 private:
  void add_text(double indent, const std::string& text);

  double x_;
  double y_;
  std::string svg_;
};

}  // namespace palpate
