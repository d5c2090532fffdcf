#include "core/recognition/counted/fewest_places.h"

#include <algorithm>
#include <cmath>
#include <vector>

#include "core/recognition/samples/cleaned/chained_touches.h"

namespace palpate {

bool have_places(const FitData& data, std::size_t count, double touch_sigma) {
  const double one_place = kOnePlace * std::sqrt(2.0) * touch_sigma;
  std::vector<Vec2> places;
  places.reserve(count);
  for (std::size_t p = 0; p < data.patches.size(); ++p) {
    const double apart = data.patches[p].size() == 1 ? one_place : 0.0;
    for (const FitPoint& point : data.patch(p)) {
      if (places.size() == count) {
        return true;
      }
      if (std::none_of(places.begin(), places.end(), [&](const Vec2& place) {
            return (point.position - place).norm() <= apart;
          })) {
        places.push_back(point.position);
      }
    }
  }
  return places.size() == count;
}

std::size_t fewest_places(CurveClass curve_class) {
  const auto parameters = static_cast<std::size_t>(degrees_of_freedom(curve_class));
  return std::max(kFewestCompared, parameters + kFewestLeftOver);
}

}  // namespace palpate
