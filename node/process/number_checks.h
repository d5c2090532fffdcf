// Checks of command-line numbers. CLI11's own let a NaN pass, and take "-1" for the largest whole
// number there is, and for it whatever is larger.
#pragma once

#include <CLI/CLI.hpp>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <sstream>
#include <string>

namespace palpate {

inline CLI::Validator positive_number() {
  const auto check = [](const std::string& text) -> std::string {
    double value = 0.0;
    const bool good = CLI::detail::lexical_cast(text, value) && std::isfinite(value) && value > 0.0;
    return good ? "" : "\"" + text + "\" is no finite number > 0";
  };
  return CLI::Validator(check, "POSITIVE");
}

inline CLI::Validator number_within(double lowest, double highest) {
  std::ostringstream bounds;
  bounds << lowest << " to " << highest;
  std::ostringstream name;  // as CLI::Range has it, which the manual pages read
  name << "FLOAT in [" << lowest << " - " << highest << "]";
  const auto check = [lowest, highest, why = bounds.str()](const std::string& text) -> std::string {
    double value = 0.0;
    const bool good = CLI::detail::lexical_cast(text, value) && value >= lowest && value <= highest;
    return good ? "" : "\"" + text + "\" is no number from " + why;
  };
  return CLI::Validator(check, name.str());
}

/// Seconds to wait, at most eleven days: what is more is a mistake.
inline CLI::Validator seconds_to_wait() { return number_within(0.0, 1e6); }

/// From 0 on, of 64 bits.
inline CLI::Validator counting_number() {
  const auto check = [](const std::string& text) -> std::string {
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool good = error == std::errc() && end == text.data() + text.size();
    return good ? "" : "\"" + text + "\" is no whole number from 0 to 18446744073709551615";
  };
  return CLI::Validator(check, "");
}

}  // namespace palpate
