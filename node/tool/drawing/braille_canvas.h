// A picture of dots for a plain terminal. A character of Unicode's braille block is two dots wide
// and four dots high, so that dots are about equally spaced in both directions.
#pragma once

#include <cstddef>
#include <cstdint>
#include <string>
#include <vector>

namespace palpate {

/// If a character has dots of several inks, the last of these in this order gives the colour.
enum class Ink : std::uint8_t { None, RivalInk, CurveInk, SampleInk };

class BrailleCanvas {
 public:
  static constexpr int kDotsAcross = 2;  // per character
  static constexpr int kDotsDown = 4;

  BrailleCanvas(std::size_t columns, std::size_t rows)
      : columns_(columns), rows_(rows), cells_(columns * rows) {}

  double width() const { return static_cast<double>(kDotsAcross * columns_); }
  double height() const { return static_cast<double>(kDotsDown * rows_); }

  /// Draws a dot; x and y count from the upper left corner. Dots outside are ignored.
  void dot(double x, double y, Ink ink);
  void line(double x0, double y0, double x1, double y1, Ink ink);

  /// The lines of the picture, in UTF-8, with the terminal's colours.
  std::vector<std::string> lines() const;

 private:
  struct Cell {
    std::uint8_t dots = 0;
    Ink ink = Ink::None;
  };

  std::size_t columns_;
  std::size_t rows_;
  std::vector<Cell> cells_;
};

}  // namespace palpate
