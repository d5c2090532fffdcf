// A value, or the sentence that says why there is none.
#pragma once

#include <optional>
#include <string>
#include <utility>

namespace palpate {

template <typename T>
struct Result {
  std::optional<T> value;
  std::string error;  ///< empty where there is a value

  static Result ok(T v) { return {std::move(v), {}}; }
  static Result fail(std::string why) { return {std::nullopt, std::move(why)}; }
  explicit operator bool() const { return value.has_value(); }
};

}  // namespace palpate
