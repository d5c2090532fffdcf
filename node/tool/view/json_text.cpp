#include "node/tool/view/json_text.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <nlohmann/json.hpp>

namespace palpate {
namespace {

bool is_plain(char character) {
  return character >= ' ' && character <= '~' && character != '"' && character != '\\';
}

}  // namespace

void JsonText::separate() {
  if (needs_comma_) text_ += ',';
  needs_comma_ = true;
}

void JsonText::begin(char bracket) {
  separate();
  text_ += bracket;
  needs_comma_ = false;
}

void JsonText::end(char bracket) {
  text_ += bracket;
  needs_comma_ = true;
}

JsonText& JsonText::key(std::string_view name) {
  separate();
  text_ += '"';
  text_ += name;
  text_ += "\":";
  needs_comma_ = false;
  return *this;
}

void JsonText::raw(std::string_view json) {
  separate();
  text_ += json;
}

// Most values are numbers; each is appended together with its comma.
template <typename... Arguments>
void JsonText::number(Arguments... arguments) {
  // Longest text: a comma, a sign, 17 digits, a point and an exponent of five characters.
  constexpr std::size_t kMostCharacters = 32;
  char characters[kMostCharacters];
  characters[0] = ',';
  char* const begin = characters + (needs_comma_ ? 1 : 0);
  const auto end = std::to_chars(begin, characters + kMostCharacters, arguments...);
  text_.append(characters, end.ptr);
  needs_comma_ = true;
}

void JsonText::value(double value) { return std::isfinite(value) ? number(value) : null(); }

void JsonText::value(double value, int digits) {
  return std::isfinite(value) ? number(value, std::chars_format::general, digits) : null();
}

void JsonText::whole(std::int64_t value) { number(value); }

void JsonText::whole(std::uint64_t value) { number(value); }

void JsonText::value(std::string_view text) {
  if (!std::all_of(text.begin(), text.end(), is_plain)) {
    using nlohmann::json;
    return raw(json(text).dump(-1, ' ', false, json::error_handler_t::replace));
  }
  separate();
  text_ += '"';
  text_ += text;
  text_ += '"';
}

}  // namespace palpate
