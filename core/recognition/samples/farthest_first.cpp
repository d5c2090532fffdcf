#include "core/recognition/samples/farthest_first.h"

#include <algorithm>
#include <limits>

namespace palpate {

std::vector<std::size_t> farthest_first(std::span<const Vec2> points, std::size_t most) {
  std::vector<double> squares(points.size(), std::numeric_limits<double>::infinity());
  std::vector<std::size_t> chosen;
  std::size_t next = 0;
  while (chosen.size() < std::min(most, points.size())) {
    chosen.push_back(next);
    const Vec2& last = points[next];
    squares[next] = -1.0;  // chosen: points that lie in one place are all the same distance away
    for (std::size_t k = 0; k < points.size(); ++k) {
      squares[k] = std::min(squares[k], (points[k] - last).squaredNorm());
    }
    next = static_cast<std::size_t>(std::max_element(squares.begin(), squares.end()) -
                                    squares.begin());
  }
  return chosen;
}

}  // namespace palpate
