#include "node/files/printable.h"

#include <gtest/gtest.h>

namespace palpate {
namespace {

TEST(Printable, PlainTextStaysAsItIs) {
  EXPECT_EQ(printable("contact/probe 1/~"), "contact/probe 1/~");
  EXPECT_EQ(printable(""), "");
}

TEST(Printable, NothingThatATerminalObeysPasses) {
  EXPECT_EQ(printable("\x1b[2Ja\nb\r\x07\x7f"), "\\x1b[2Ja\\x0ab\\x0d\\x07\\x7f");
  EXPECT_EQ(printable("\xc2\x9b"), "\\xc2\\x9b");  // the one-byte CSI, as UTF-8
  for (int byte = 0; byte < 256; ++byte) {
    for (const char c : printable(std::string(1, static_cast<char>(byte)))) {
      EXPECT_TRUE(c >= ' ' && c <= '~') << byte;
    }
  }
}

TEST(Printable, PathsKeepTheirLettersButNothingThatATerminalObeys) {
  EXPECT_EQ(printable_path("a/St\xc3\xbc\x63k \xe2\x86\x92 1.csv"),
            "a/St\xc3\xbc\x63k \xe2\x86\x92 1.csv");
  EXPECT_EQ(printable_path("\x1b[2Ja\nb\x7f\xc2\x9b\xc2\xb5m"),
            "\\x1b[2Ja\\x0ab\\x7f\\xc2\\x9b\xc2\xb5m");
  EXPECT_EQ(printable_path("\xc2"), "\xc2");
}

TEST(Printable, NoLongerThanAsked) { EXPECT_EQ(printable("abcdef", 3), "abc..."); }

}  // namespace
}  // namespace palpate
