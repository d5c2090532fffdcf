// Numbers of a message to the browser, as short as they may be.
#pragma once

#include <nlohmann/json.hpp>

#include "core/curves/pose2.h"

namespace palpate {

/// A number to so many significant digits: short in text.
double significant(double value, int digits);

/// Digits of what charts show: a hundredth of a pixel of a thousand.
inline constexpr int kChartDigits = 5;

/// Places as whole steps from an origin: whole numbers are written many times faster than others,
/// and are short.
class StepCoordinates {
 public:
  StepCoordinates(const Vec2& origin_m, double step_m) : origin_m_(origin_m), step_m_(step_m) {}

  /// Appends x and y; nothing, and false, where the place is too far away to be written, or none.
  bool add(nlohmann::json::array_t& steps, const Vec2& place) const;

  double step_m() const { return step_m_; }

 private:
  Vec2 origin_m_;
  double step_m_;
};

}  // namespace palpate
