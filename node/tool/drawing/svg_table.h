// The text beside a drawing, in SVG: headings, rows, sentences and the legend.
#pragma once

#include <cstdio>
#include <string>

namespace palpate {

/// Printf-formatted text of at most 511 characters.
template <typename... Values>
std::string formatted(const char* pattern, Values... values) {
  char text[512];
  std::snprintf(text, sizeof text, pattern, values...);
  return text;
}

/// The text, escaped for use in markup.
std::string escaped(const std::string& text);

/// Writes lines from a position downwards. [px]
class SvgTable {
 public:
  SvgTable(double x, double y) : x_(x), y_(y) {}

  void heading(const std::string& text);
  void row(const std::string& name, const std::string& value);
  /// Breaks the text into lines that fit.
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
