// Writes JSON directly into a string. A picture has thousands of numbers, and a tree of JSON values
// would cost more than the drawing.
#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace palpate {

/// The caller must close what it opens, and give keys to members of objects only.
class JsonText {
 public:
  void begin_object() { begin('{'); }
  void end_object() { end('}'); }
  void begin_array() { begin('['); }
  void end_array() { end(']'); }

  /// The key of the next value. A literal of this program; it is not escaped.
  JsonText& key(std::string_view name);

  /// The shortest text that gives the same number; null if it is not finite.
  void value(double value);
  /// The number to `digits` significant digits.
  void value(double value, int digits);
  void value(std::signed_integral auto value) { whole(static_cast<std::int64_t>(value)); }
  void value(std::unsigned_integral auto value) { whole(static_cast<std::uint64_t>(value)); }
  void value(bool truth) { raw(truth ? "true" : "false"); }
  /// Any bytes: special characters are escaped, and what is not UTF-8 is replaced.
  void value(std::string_view text);
  void value(const std::string& text) { value(std::string_view(text)); }
  void value(const char* text) { value(std::string_view(text)); }
  void null() { raw("null"); }
  /// JSON that is already written.
  void raw(std::string_view json);

  template <typename... Value>
  void member(std::string_view name, Value&&... its_value) {
    key(name).value(std::forward<Value>(its_value)...);
  }

  const std::string& text() const { return text_; }
  /// Returns what has been written and starts anew.
  std::string take() {
    needs_comma_ = false;
    return std::exchange(text_, {});
  }

 private:
  void begin(char bracket);
  void end(char bracket);
  void separate();
  void whole(std::int64_t value);
  void whole(std::uint64_t value);
  template <typename... Arguments>
  void number(Arguments... arguments);

  std::string text_;
  bool needs_comma_ = false;
};

}  // namespace palpate
