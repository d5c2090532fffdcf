// A value, or an error message if there is none.
#pragma once

#include <optional>
#include <string>
#include <utility>

namespace palpate {

template <typename T>
struct Result {
  std::optional<T> value;
  std::string error;  ///< empty if there is a value

  static Result ok(T v) { return {std::move(v), {}}; }
  static Result fail(std::string why) { return {std::nullopt, std::move(why)}; }
  explicit operator bool() const { return value.has_value(); }
};

}  // namespace palpate
