#include "core/recognition/fit/starts/farthest_first.h"

#include <algorithm>
#include <cmath>
#include <limits>

namespace palpate {
namespace {

/// `least_square`: square of the least distance. Negative values also admit points at the same
/// place.
Spread spread_by_squares(std::span<const Vec2> points, std::size_t most, double least_square) {
  Spread spread;
  spread.nearest.assign(points.size(), 0);
  most = std::min(most, points.size());
  std::vector<double> squares(points.size(), std::numeric_limits<double>::infinity());
  double apart = std::numeric_limits<double>::infinity();
  std::size_t next = 0;
  while (spread.chosen.size() < most && squares[next] > least_square) {
    apart = squares[next];
    const Vec2& last = points[next];
    squares[next] = -1.0;  // marks it as chosen: points at the same place are all at distance 0
    spread.nearest[next] = spread.chosen.size();
    double farthest = -std::numeric_limits<double>::infinity();
    std::size_t at = next;
    for (std::size_t k = 0; k < points.size(); ++k) {
      const double square = (points[k] - last).squaredNorm();
      if (square < squares[k]) {
        squares[k] = square;
        spread.nearest[k] = spread.chosen.size();
      }
      if (squares[k] > farthest) {
        farthest = squares[k];
        at = k;
      }
    }
    spread.chosen.push_back(next);
    next = at;
  }
  spread.apart = std::sqrt(apart);
  return spread;
}

}  // namespace

Spread spread_widest(std::span<const Vec2> points, std::size_t most, double least) {
  return spread_by_squares(points, most, least * least);
}

std::vector<std::size_t> farthest_first(std::span<const Vec2> points, std::size_t most) {
  constexpr double kAnyDistance = -2.0;
  return spread_by_squares(points, most, kAnyDistance).chosen;
}

}  // namespace palpate
