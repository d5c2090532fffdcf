#include "core/recognition/fewest_places.h"

#include <algorithm>
#include <vector>

namespace palpate {

bool have_places(const FitData& data, std::size_t count) {
  std::vector<Vec2> places;
  places.reserve(count);
  for (const FitPoint& point : data.points) {
    if (places.size() == count) {
      break;
    }
    if (std::find(places.begin(), places.end(), point.position) == places.end()) {
      places.push_back(point.position);
    }
  }
  return places.size() == count;
}

std::size_t fewest_places(const Recognition& answer) {
  const CurveClass curve_class = answer.shape.curve_class;
  if (curve_class == CurveClass::Unclassified) {
    return kFewestPlaces;
  }
  const auto parameters = static_cast<std::size_t>(degrees_of_freedom(curve_class));
  return std::max(kFewestCompared, parameters + kFewestLeftOver) + answer.outlier_count;
}

}  // namespace palpate
