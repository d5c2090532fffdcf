#include "core/recognition/samples/stroke_order.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/recognition/samples/step_ratio.h"

namespace palpate {

bool show_order(std::span<const Vec2> stroke) {
  const auto n = static_cast<double>(stroke.size());
  Vec2 mean = Vec2::Zero();
  for (const Vec2& place : stroke) {
    mean += place / n;
  }
  double square = 0.0;
  for (const Vec2& place : stroke) {
    square += (place - mean).squaredNorm() / n;
  }
  return step_ratio([&](std::size_t i) { return stroke[i]; }, 0, stroke.size(), square) < kNoOrder;
}

bool leads_to_and_fro(std::span<const Vec2> stroke) {
  if (stroke.size() < kFewestInOrder || show_order(stroke)) {
    return false;
  }
  // Of the extent. Where as many as a third of dense samples are spikes, almost half the steps join
  // two that are none.
  constexpr double kLongStep = 0.1;
  constexpr std::size_t kOneInSteps = 3;
  Vec2 low = stroke.front();
  Vec2 high = stroke.front();
  std::vector<double> steps;
  for (std::size_t i = 1; i < stroke.size(); ++i) {
    low = low.cwiseMin(stroke[i]);
    high = high.cwiseMax(stroke[i]);
    steps.push_back((stroke[i] - stroke[i - 1]).norm());
  }
  const auto third = steps.begin() + static_cast<std::ptrdiff_t>(steps.size() / kOneInSteps);
  std::nth_element(steps.begin(), third, steps.end());
  return *third > kLongStep * (high - low).norm();
}

bool lead_mostly_to_and_fro(std::span<const StoredPatch> patches) {
  std::size_t all = 0;
  std::size_t unordered = 0;
  std::vector<Vec2> places;
  for (const StoredPatch& patch : patches) {
    places.clear();
    for (const StoredSample& sample : patch.samples) {
      places.push_back(sample.position_m);
    }
    all += places.size();
    unordered += leads_to_and_fro(places) ? places.size() : 0;
  }
  return 2 * unordered > all;
}

}  // namespace palpate
