// Short coordinates for messages to the browser.
#pragma once

#include <cmath>
#include <cstdint>
#include <optional>

#include "core/curves/pose2.h"
#include "node/tool/view/json_text.h"

namespace palpate {

/// Significant digits in charts: a hundredth of a pixel of a thousand.
inline constexpr int kChartDigits = 5;

/// Coordinates as whole steps from an origin. Integers are short and many times faster to write
/// than other numbers.
class StepCoordinates {
 public:
  struct Steps {
    std::int64_t x = 0;
    std::int64_t y = 0;
  };

  StepCoordinates(const Vec2& origin_m, double step_m) : origin_m_(origin_m), step_m_(step_m) {}

  /// nullopt if the place is not finite or too far away for an integer.
  std::optional<Steps> steps_to(const Vec2& place) const {
    constexpr double kMost = 9007199254740992.0;  // 2^53: whole numbers of JavaScript
    const double x = std::round((place.x() - origin_m_.x()) / step_m_);
    const double y = std::round((place.y() - origin_m_.y()) / step_m_);
    if (!(std::abs(x) < kMost && std::abs(y) < kMost)) return std::nullopt;
    return Steps{static_cast<std::int64_t>(x), static_cast<std::int64_t>(y)};
  }

  /// Writes x and y, or nothing if they cannot be written.
  void write(const Vec2& place, JsonText& json) const {
    if (const std::optional<Steps> steps = steps_to(place)) write(*steps, json);
  }

  static void write(const Steps& steps, JsonText& json) {
    json.value(steps.x);
    json.value(steps.y);
  }

  double step_m() const { return step_m_; }

 private:
  Vec2 origin_m_;
  double step_m_;
};

}  // namespace palpate
