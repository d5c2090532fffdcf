#include "node/tool/view/json_numbers.h"

#include <cmath>
#include <cstdint>

namespace palpate {

double significant(double value, int digits) {
  if (value == 0.0 || !std::isfinite(value)) return value;
  const double power = std::pow(10.0, digits - 1 - std::floor(std::log10(std::abs(value))));
  return std::isfinite(power) && power > 0.0 ? std::round(value * power) / power : value;
}

bool StepCoordinates::add(nlohmann::json::array_t& steps, const Vec2& place) const {
  constexpr double kMost = 9007199254740992.0;  // 2^53: whole numbers of JavaScript
  const double x = std::round((place.x() - origin_m_.x()) / step_m_);
  const double y = std::round((place.y() - origin_m_.y()) / step_m_);
  if (!(std::abs(x) < kMost && std::abs(y) < kMost)) return false;
  steps.emplace_back(static_cast<std::int64_t>(x));
  steps.emplace_back(static_cast<std::int64_t>(y));
  return true;
}

}  // namespace palpate
