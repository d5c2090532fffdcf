#include "node/files/quantity.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <iterator>

namespace palpate {
namespace {

std::string print(const char* format, int precision, double value) {
  char text[64];
  std::snprintf(text, sizeof text, format, precision, value);
  return text;
}

}  // namespace

std::string number(double value) { return print("%.*g", 6, value); }

std::string with_sigma(double value, double sigma) {
  if (!(sigma > 0.0)) {
    return number(value);
  }
  if (!std::isfinite(sigma) || !std::isfinite(value)) {
    return number(value) + " +- " + number(sigma);
  }
  constexpr int kSigmaDigits = 2;
  constexpr int kMostDecimals = 9;  // with more decimals, or none: powers of ten
  const int decimals = kSigmaDigits - 1 - static_cast<int>(std::floor(std::log10(sigma)));
  if (decimals >= 0 && decimals <= kMostDecimals) {
    return print("%.*f", decimals, value) + " +- " + print("%.*f", decimals, sigma);
  }
  const double larger = std::max(std::abs(value), sigma);
  const int digits =
      std::clamp(static_cast<int>(std::floor(std::log10(larger))) + decimals, kSigmaDigits - 1, 16);
  return print("%.*e", digits, value) + " +- " + print("%.*e", kSigmaDigits - 1, sigma);
}

std::string with_digits(double value, int digits) {
  return number(std::strtod(print("%.*e", digits - 1, value).c_str(), nullptr));
}

LengthUnit length_unit_for(double magnitude_m) {
  if (magnitude_m == 0.0) return {"m", 1.0};
  constexpr LengthUnit kUnits[] = {{"m", 1.0}, {"mm", 1e3}, {"um", 1e6}, {"nm", 1e9}};
  // The micrometre is what people measure in: nothing is in nanometres before it must be.
  constexpr double kLeast[] = {1.0, 1.0, 0.1, 0.0};
  for (std::size_t i = 0; i < std::size(kUnits); ++i) {
    if (magnitude_m * kUnits[i].per_m >= kLeast[i]) return kUnits[i];
  }
  return kUnits[0];  // NaN
}

std::string text_of_length(double metres) {
  const LengthUnit unit = length_unit_for(metres);
  return number(metres * unit.per_m) + " " + std::string(unit.name);
}

}  // namespace palpate
