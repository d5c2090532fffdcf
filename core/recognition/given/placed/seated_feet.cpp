#include "core/recognition/given/placed/seated_feet.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "core/recognition/given/placed/foot_parameter.h"
#include "core/recognition/given/placed/stroke_feet.h"

namespace palpate {

bool seat_globally(PlacedCurve<double>* placed, std::span<const WeighedPoint<double>> points) {
  const auto curve = curve_of(*placed);
  if (!curve) {
    return false;
  }
  placed->feet.resize(points.size());
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PlaneVector<double> p = placed->to_curve(points[i].position);
    const FootPoint foot = foot_point(*curve, {p.x, p.y});
    if (!std::isfinite(foot.distance)) {
      return false;
    }
    placed->feet[i] = parameter_at(placed->curve_class, foot.t);
  }
  return put_in_order(placed, points);
}

bool seat_nearby(PlacedCurve<double>* placed, std::span<const WeighedPoint<double>> points) {
  const auto curve = curve_of(*placed);
  if (!curve) {
    return false;
  }
  for (std::size_t i = 0; i < points.size(); ++i) {
    const PlaneVector<double> p = placed->to_curve(points[i].position);
    const double t = t_at(placed->curve_class, placed->feet[i]);
    const FootPoint foot = foot_point_near(*curve, {p.x, p.y}, t);
    if (!std::isfinite(foot.distance)) {
      return false;
    }
    placed->feet[i] = parameter_at(placed->curve_class, foot.t);
  }
  return true;
}

bool is_on_arm(int arm, const PlacedCurve<double>& placed) {
  return std::all_of(placed.feet.begin(), placed.feet.end(),
                     [arm](const PlaneVector<double>& foot) { return arm * foot.x > 0.0; });
}

bool seat_on_arm(int arm, PlacedCurve<double>* placed,
                 std::span<const WeighedPoint<double>> points) {
  double farthest = 0.0;
  for (const WeighedPoint<double>& point : points) {
    farthest = std::max(farthest, placed->to_curve(point.position).x);
  }
  // So near one another that Newton's method reaches the foot from the nearest one.
  constexpr int kPlaces = 48;
  std::array<PlaneVector<double>, kPlaces> places;
  std::array<double, kPlaces> t{};
  for (std::size_t k = 0; k < kPlaces; ++k) {
    t[k] = arm * std::sqrt(farthest) * (static_cast<double>(k) + 0.5) / kPlaces;
    places[k] = curve_point<double>(placed->curve_class, placed->shape, {t[k], 0.0}).position;
  }
  placed->feet.clear();
  for (const WeighedPoint<double>& point : points) {
    const PlaneVector<double> p = placed->to_curve(point.position);
    std::size_t nearest = 0;
    double least = std::numeric_limits<double>::infinity();
    for (std::size_t k = 0; k < kPlaces; ++k) {
      const PlaneVector<double> away = p - places[k];
      const double square = inner(away, away);
      nearest = square < least ? k : nearest;
      least = std::min(least, square);
    }
    placed->feet.push_back({t[nearest], 0.0});
  }
  return seat_nearby(placed, points) && is_on_arm(arm, *placed);
}

}  // namespace palpate
