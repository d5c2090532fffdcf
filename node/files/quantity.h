// Numbers for people, with as many digits as their uncertainty justifies.
#pragma once

#include <cstdio>
#include <numbers>
#include <string>
#include <string_view>

namespace palpate {

inline constexpr double kDegrees = 180.0 / std::numbers::pi;  ///< degrees per radian

/// Appends printf-formatted text of at most 255 characters.
template <typename... Values>
void add_row(std::string& text, const char* format, Values... values) {
  char row[256];
  std::snprintf(row, sizeof row, format, values...);
  text += row;
}

/// E.g. "12.3456 +- 0.0021": the standard deviation to two significant digits, the value to the
/// same place. If sigma is 0 (not known): the value to six significant digits. If it is not finite:
/// "+- inf".
std::string with_sigma(double value, double sigma);

/// Six significant digits.
std::string number(double value);

/// So many significant digits, without an exponent up to a million.
std::string with_digits(double value, int digits);

/// A unit of length that suits the magnitude: m, mm, um or nm.
struct LengthUnit {
  std::string_view name;
  double per_m = 1.0;
};
LengthUnit length_unit_for(double magnitude_m);

/// "25 mm": six digits, in the unit of length_unit_for().
std::string text_of_length(double metres);

}  // namespace palpate
