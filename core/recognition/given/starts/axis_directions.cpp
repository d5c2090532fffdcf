#include "core/recognition/given/starts/axis_directions.h"

#include <algorithm>
#include <cmath>

namespace palpate {

std::vector<double> axis_directions(std::span<const Vec2> points, double turn) {
  constexpr int kDirections = 120;  // of `turn`
  const double step = turn / kDirections;
  Vec2 mean = Vec2::Zero();
  for (const Vec2& point : points) {
    mean += point / static_cast<double>(points.size());
  }
  double xx = 0.0;
  double xy = 0.0;
  double yy = 0.0;
  for (const Vec2& point : points) {
    const Vec2 d = point - mean;
    xx += d.x() * d.x();
    xy += d.x() * d.y();
    yy += d.y() * d.y();
  }
  const double along = 0.5 * std::atan2(2.0 * xy, xx - yy);  // of the longer axis of the points
  const double spread = std::hypot(xx - yy, 2.0 * xy);
  const double slimness = std::sqrt(std::max(0.0, (xx + yy - spread) / (xx + yy + spread)));
  std::vector<double> angles;
  for (int k = 0; k < kDirections; ++k) {
    angles.push_back(k * step);
    // A line across the axis at this angle to the stretched points' longer axis.
    const double stretched = (k + 0.5) * step;
    const double across = std::atan2(slimness * std::sin(stretched), std::cos(stretched));
    // Only where these are closer to one another: near the longer axis.
    if (std::abs(std::sin(across)) < std::sqrt(slimness) * std::abs(std::cos(across))) {
      const double angle = std::fmod(along + across - 0.5 * kPi + 2.0 * turn, turn);
      angles.push_back(angle);
    }
  }
  std::sort(angles.begin(), angles.end());
  return angles;
}

}  // namespace palpate
