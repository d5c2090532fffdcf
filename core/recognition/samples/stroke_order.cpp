#include "core/recognition/samples/stroke_order.h"

#include <algorithm>
#include <cstddef>
#include <vector>

#include "core/numerics/quantile.h"
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

bool leads_to_and_fro(std::span<const Vec2> stroke, double extent) {
  // Once round a part by n samples has the ratio 2 sin^2(pi / n): 0.5 for six, 0.38 for seven.
  constexpr std::size_t kFewest = 7;
  // Of the extent. Where as many as a third of dense samples are spikes, almost half the steps join
  // two that are none.
  constexpr double kLongStep = 0.1;
  constexpr std::size_t kOneInSteps = 3;
  std::vector<Vec2> places;
  std::vector<double> steps;
  for (const Vec2& place : stroke) {
    if (!places.empty()) {
      if (place == places.back()) {
        continue;  // told twice
      }
      steps.push_back((place - places.back()).norm());
    }
    places.push_back(place);
  }
  if (places.size() < kFewest || show_order(places)) {
    return false;
  }
  return ranked(steps, steps.size() / kOneInSteps) > kLongStep * extent;
}

bool lead_mostly_to_and_fro(std::span<const StoredPatch> patches) {
  const Eigen::AlignedBox2d box = box_of(patches);
  const double extent_m = box.isEmpty() ? 0.0 : box.diagonal().norm();
  std::size_t all = 0;
  std::size_t unordered = 0;
  std::vector<Vec2> places;
  for (const StoredPatch& patch : patches) {
    places.clear();
    for (const StoredSample& sample : patch.samples) {
      places.push_back(sample.position_m);
    }
    all += places.size();
    unordered += leads_to_and_fro(places, extent_m) ? places.size() : 0;
  }
  return 2 * unordered > all;
}

}  // namespace palpate
