// A check of command-line numbers.
#pragma once

#include <CLI/CLI.hpp>
#include <charconv>
#include <cstdint>
#include <string>

namespace palpate {

/// Refuses what is no whole number from 0 on, or larger than 64 bits hold: CLI11 takes "-1" for the
/// largest there is, and for it whatever is larger.
inline CLI::Validator whole_number() {
  const auto check = [](std::string& text) -> std::string {
    std::uint64_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size()
               ? ""
               : "\"" + text + "\" is no whole number from 0 to 18446744073709551615";
  };
  return CLI::Validator(check, "");
}

}  // namespace palpate
