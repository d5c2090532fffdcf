#include "node/tool/drawing/braille_canvas.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace palpate {
namespace {

// Bits of Unicode's braille patterns (from U+2800), by row and column of the dot.
constexpr std::uint8_t kBitOfDot[4][2] = {{0x01, 0x08}, {0x02, 0x10}, {0x04, 0x20}, {0x40, 0x80}};

/// The character U+2800 + dots in UTF-8.
std::string braille(std::uint8_t dots) {
  const char bytes[] = {'\xe2', static_cast<char>(0xa0 + (dots >> 6)),
                        static_cast<char>(0x80 + (dots & 0x3f))};
  return {bytes, sizeof bytes};
}

const char* escape_of(Ink ink) {
  switch (ink) {
    case Ink::RivalInk:
      return "\033[35m";
    case Ink::SampleInk:
      return "\033[36m";
    default:
      return "\033[0m";
  }
}

}  // namespace

void BrailleCanvas::dot(double x, double y, Ink ink) {
  if (!(x >= 0.0 && x < width() && y >= 0.0 && y < height())) return;
  const auto across = static_cast<std::size_t>(x);
  const auto down = static_cast<std::size_t>(y);
  Cell& cell = cells_[down / kDotsDown * columns_ + across / kDotsAcross];
  cell.dots |= kBitOfDot[down % kDotsDown][across % kDotsAcross];
  cell.ink = std::max(cell.ink, ink);
}

void BrailleCanvas::line(double x0, double y0, double x1, double y1, Ink ink) {
  // Clip the line to the canvas (Liang and Barsky).
  const double dx = x1 - x0;
  const double dy = y1 - y0;
  // Not a line, or too long for a double.
  if (!std::isfinite(dx) || !std::isfinite(dy)) return;
  double from = 0.0;
  double to = 1.0;
  for (const auto& [step, room] :
       {std::pair(-dx, x0), {dx, width() - x0}, {-dy, y0}, {dy, height() - y0}}) {
    // A line parallel to a border and beyond it is entirely outside.
    if (step == 0.0 && room < 0.0) return;
    if (step < 0.0) from = std::max(from, room / step);
    if (step > 0.0) to = std::min(to, room / step);
  }
  if (!(from <= to)) return;
  // Number of dots of the clipped line. For a line so long that its ends are rounded, no more than
  // the canvas has.
  const auto steps = static_cast<int>(
      std::min(std::ceil((to - from) * std::max(std::abs(dx), std::abs(dy))), width() + height()));
  for (int i = 0; i <= steps; ++i) {
    const double part = from + (to - from) * (steps > 0 ? static_cast<double>(i) / steps : 0.0);
    dot(x0 + part * dx, y0 + part * dy, ink);
  }
}

std::vector<std::string> BrailleCanvas::lines() const {
  std::vector<std::string> lines;
  for (std::size_t row = 0; row < rows_; ++row) {
    std::string line;
    Ink ink = Ink::None;
    for (std::size_t column = 0; column < columns_; ++column) {
      const Cell& cell = cells_[row * columns_ + column];
      if (cell.dots != 0 && cell.ink != ink) {
        line += escape_of(cell.ink);
        ink = cell.ink;
      }
      line += cell.dots == 0 ? " " : braille(cell.dots);
    }
    line.erase(line.find_last_not_of(' ') + 1);
    if (ink != Ink::None) line += "\033[0m";
    lines.push_back(line);
  }
  return lines;
}

}  // namespace palpate
