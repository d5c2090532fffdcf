// Numbers as a person reads them: with as many digits as their uncertainty leaves.
#pragma once

#include <cstdio>
#include <numbers>
#include <string>
#include <string_view>

namespace palpate {

inline constexpr double kDegrees = 180.0 / std::numbers::pi;  ///< per radian

/// Appends what printf makes of the values, up to 255 characters.
template <typename... Values>
void add_row(std::string& text, const char* format, Values... values) {
  char row[256];
  std::snprintf(row, sizeof row, format, values...);
  text += row;
}

/// "12.3456 +- 0.0021": the standard deviation to two significant digits, the value to the same
/// place. Without uncertainty (0): six significant digits; where it is not finite: "+- inf".
std::string with_sigma(double value, double sigma);

/// Six significant digits.
std::string number(double value);

/// A unit of length that suits a magnitude: m, mm, um or nm.
struct LengthUnit {
  std::string_view name;
  double per_m = 1.0;
};
LengthUnit length_unit_for(double magnitude_m);

/// "25 mm": six digits, in the unit of length_unit_for().
std::string text_of_length(double metres);

}  // namespace palpate
