#include "node/tool/drawing/svg/svg_text.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

constexpr double kFont = 12.0;

TEST(SvgText, EscapesMarkupAndWhatXmlDoesNotPermit) {
  EXPECT_EQ(escaped("a<b>&\"c\""), "a&lt;b&gt;&amp;&quot;c&quot;");
  EXPECT_EQ(escaped("\x01\n"), "??");
  EXPECT_EQ(escaped("W\xc3\xb6rter \xd0\x81 \xf0\x9f\x98\x80"),
            "W\xc3\xb6rter \xd0\x81 \xf0\x9f\x98\x80");
  // The end of a letter, its beginning, one written too long, a surrogate, U+FFFF.
  EXPECT_EQ(escaped("\xb6"), "?");
  EXPECT_EQ(escaped("a\xc3"), "a?");
  EXPECT_EQ(escaped("\xc0\x80"), "??");
  EXPECT_EQ(escaped("\xed\xa0\x80"), "???");
  EXPECT_EQ(escaped("\xef\xbf\xbf"), "?");
}

TEST(SvgText, BreaksAtBlanksElseWithinTheWordAndLosesNothing) {
  EXPECT_EQ(lines_within("", 100.0, kFont), std::vector<std::string>{""});
  EXPECT_EQ(lines_within("a b", 100.0, kFont), std::vector<std::string>{"a b"});
  for (const std::string text :
       {"The part is an ellipse: its shape and place are known.",
        "WWWWWWWWWWWWWWWWWWWWWWWWW, patch 7",
        "\xd0\x81\xd0\x81\xd0\x81\xd0\x81\xd0\x81\xd0\x81\xd0\x81\xd0\x81\xd0\x81"}) {
    std::string letters;
    for (const std::string& line : lines_within(text, 80.0, kFont)) {
      EXPECT_LE(text_width_px(line, kFont), 80.0) << line;
      EXPECT_EQ(escaped(line), line) << "a letter is cut";
      for (const char c : line) letters += c == ' ' ? "" : std::string(1, c);
    }
    std::string expected;
    for (const char c : text) expected += c == ' ' ? "" : std::string(1, c);
    EXPECT_EQ(letters, expected);
  }
  // Narrower than any letter.
  EXPECT_EQ(lines_within("WW", 1.0, kFont).size(), 2U);
}

TEST(SvgText, OfAPathTheEndIsShown) {
  EXPECT_EQ(end_within("part.csv", 200.0, kFont), "part.csv");
  const std::string path = "/data/\xd0\x81\xd0\x81\xd0\x81\xd0\x81\xd0\x81\xd0\x81/part.csv";
  for (double width = 60.0; width < 160.0; width += 1.0) {
    const std::string shown = end_within(path, width, kFont);
    EXPECT_LE(text_width_px(shown, kFont), width) << shown;
    EXPECT_EQ(shown.substr(0, 3), "...");
    EXPECT_EQ(escaped(shown), shown) << "a letter is cut";
    EXPECT_TRUE(path.ends_with(shown.substr(3)));
  }
}

}  // namespace
}  // namespace palpate
