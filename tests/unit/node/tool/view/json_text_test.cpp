#include "node/tool/view/json_text.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>
#include <nlohmann/json.hpp>

namespace palpate {
namespace {

TEST(JsonText, IsReadBackAsItWasWritten) {
  JsonText json;
  json.begin_object();
  json.member("third", 1.0 / 3.0);
  json.member("tiny", -std::numeric_limits<double>::denorm_min());
  json.member("least", std::numeric_limits<std::int64_t>::min());
  json.member("most", std::numeric_limits<std::uint64_t>::max());
  json.member("word", "true");
  json.member("truth", true);
  json.key("none").null();
  json.key("empty").begin_array();
  json.end_array();
  json.key("nested").begin_array();
  json.begin_object();
  json.end_object();
  json.begin_array();
  json.value(1);
  json.value(2U);
  json.end_array();
  json.raw("[3]");
  json.end_array();
  json.end_object();
  const auto read = nlohmann::json::parse(json.take());
  EXPECT_EQ(read["third"], 1.0 / 3.0);
  EXPECT_EQ(read["tiny"], -std::numeric_limits<double>::denorm_min());
  EXPECT_EQ(read["least"], std::numeric_limits<std::int64_t>::min());
  EXPECT_EQ(read["most"], std::numeric_limits<std::uint64_t>::max());
  EXPECT_EQ(read["word"], "true");
  EXPECT_EQ(read["truth"], true);
  EXPECT_TRUE(read["none"].is_null());
  EXPECT_EQ(read["empty"], nlohmann::json::array());
  EXPECT_EQ(read["nested"], nlohmann::json::parse("[{}, [1, 2], [3]]"));
  EXPECT_EQ(read.size(), 9U);
  json.value(7);  // begins anew
  EXPECT_EQ(json.text(), "7");
}

TEST(JsonText, RoundsToDigitsAndHasNoNumberThatIsNone) {
  const auto text = [](double value, int digits) {
    JsonText json;
    json.value(value, digits);
    return json.take();
  };
  constexpr double kInfinity = std::numeric_limits<double>::infinity();
  EXPECT_EQ(text(123.456, 4), "123.5");
  EXPECT_EQ(text(0.0, 4), "0");
  EXPECT_EQ(text(kInfinity, 4), "null");
  EXPECT_EQ(text(std::numeric_limits<double>::quiet_NaN(), 4), "null");
  for (const double value : {-98765.4321, 1.23456e-300, 9.87654e300, 2e22, -4e-5}) {
    const double read = nlohmann::json::parse(text(value, 5));
    EXPECT_NEAR(read / value, 1.0, 0.5e-4);
    EXPECT_LE(text(value, 5).size(), 12U);
  }
  JsonText json;
  json.begin_array();
  json.value(kInfinity);
  json.value(-kInfinity);
  json.end_array();
  EXPECT_EQ(json.take(), "[null,null]");
}

TEST(JsonText, TakesTextOfAnyBytes) {
  for (int first = 0; first < 256; ++first) {
    for (const char* rest : {"", "plain", "\xff"}) {
      const std::string bytes = static_cast<char>(first) + std::string(rest);
      JsonText json;
      json.value(bytes);
      const std::string read = nlohmann::json::parse(json.text());
      const bool is_ascii = first < 0x80 && std::string_view(rest) != "\xff";
      if (is_ascii) {
        EXPECT_EQ(read, bytes);
      } else {
        EXPECT_NE(read.find("\xef\xbf\xbd"), std::string::npos);  // what is not UTF-8 is replaced
      }
    }
  }
  JsonText json;
  json.value("\xc3\xa9\"</script>");
  EXPECT_EQ(nlohmann::json::parse(json.take()), "\xc3\xa9\"</script>");
}

}  // namespace
}  // namespace palpate
