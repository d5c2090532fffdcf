// JSON written straight into a string: a picture is thousands of numbers, and a tree of them costs
// more than the drawing.
#pragma once

#include <concepts>
#include <cstdint>
#include <string>
#include <string_view>
#include <utility>

namespace palpate {

/// Whoever writes sees to it that what begins also ends, and that only members of objects have
/// keys.
class JsonText {
 public:
  void begin_object() { begin('{'); }
  void end_object() { end('}'); }
  void begin_array() { begin('['); }
  void end_array() { end(']'); }

  /// Name of the member whose value comes next; ours, without anything to escape.
  JsonText& key(std::string_view name);

  /// The shortest number that is this one; null where it is not finite.
  void value(double value);
  /// To so many significant digits: short.
  void value(double value, int digits);
  void value(std::signed_integral auto value) { whole(static_cast<std::int64_t>(value)); }
  void value(std::unsigned_integral auto value) { whole(static_cast<std::uint64_t>(value)); }
  void value(bool truth) { raw(truth ? "true" : "false"); }
  /// Any bytes: they are escaped, and what is not UTF-8 is replaced.
  void value(std::string_view text);
  void value(const std::string& text) { value(std::string_view(text)); }
  void value(const char* text) { value(std::string_view(text)); }
  void null() { raw("null"); }
  /// JSON already written.
  void raw(std::string_view json);

  template <typename... Value>
  void member(std::string_view name, Value&&... its_value) {
    key(name).value(std::forward<Value>(its_value)...);
  }

  const std::string& text() const { return text_; }
  /// What has been written; it begins anew.
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
