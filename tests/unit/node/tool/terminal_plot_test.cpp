#include "node/tool/drawing/terminal_plot.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <cmath>
#include <limits>
#include <numbers>

#include "node/tool/drawing/braille_canvas.h"

namespace palpate {
namespace {

using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;
using testing::SizeIs;

TEST(BrailleCanvas, PutsEachDotWhereUnicodeHasIt) {
  // U+2801, U+2880: the first and the last dot of a character.
  BrailleCanvas canvas(2, 1);
  canvas.dot(0.5, 0.5, Ink::CurveInk);
  canvas.dot(3.5, 3.5, Ink::CurveInk);
  EXPECT_THAT(canvas.lines(), ElementsAre("\033[0m\u2801\u2880\033[0m"));
}

TEST(BrailleCanvas, DrawsOfALineWhatLiesWithinIt) {
  BrailleCanvas whole(3, 1);
  whole.line(-1e9, 1.5, 1e9, 1.5, Ink::CurveInk);
  EXPECT_THAT(whole.lines(), ElementsAre("\033[0m\u2812\u2812\u2812\033[0m"));
  BrailleCanvas beside(3, 1);
  beside.line(-10.0, -1.0, 10.0, -1.0, Ink::CurveInk);
  beside.line(-10.0, 5.0, -1.0, 100.0, Ink::CurveInk);
  beside.dot(std::numeric_limits<double>::quiet_NaN(), 0.0, Ink::CurveInk);
  for (const double beyond : {std::numeric_limits<double>::quiet_NaN(),
                              std::numeric_limits<double>::infinity(), 1.7e308}) {
    beside.line(-beyond, 1.0, beyond, 1.0, Ink::CurveInk);
    beside.line(1.0, beyond, 1.0, -beyond, Ink::CurveInk);
  }
  EXPECT_THAT(beside.lines(), ElementsAre(""));
  beside.line(-1e300, 1.5, 1e300, 1.5, Ink::CurveInk);  // its ends are all one to a double
  EXPECT_EQ(beside.lines().size(), 1U);
}

/// Half of a circle of 20 mm, and the answer that it is one.
ContactGroup half_circle() {
  ContactGroup group{"", "part", 3, {"probe"}, {{}}};
  for (int i = 0; i <= 100; ++i) {
    const double angle = std::numbers::pi * i / 100;
    group.runs[0].samples.push_back(
        {{0.3 + 0.02 * std::cos(angle), 0.02 * std::sin(angle)}, 1e-5, 0});
  }
  return group;
}

v1::Recognition circle_answer() {
  v1::Recognition answer;
  answer.set_status(v1::RECOGNITION_STATUS_RECOGNIZED);
  answer.set_curve_class(v1::CURVE_CLASS_CIRCLE);
  answer.mutable_parameters()->set_a(0.02);
  answer.mutable_pose()->set_x_m(0.3);
  return answer;
}

/// Characters that are no blank, in what the terminal shows.
std::size_t marks(const std::string& line) {
  std::size_t count = 0;
  for (const char byte : line) count += byte == '\xe2' ? 1U : 0U;
  return count;
}

TEST(TerminalPlot, ShowsSamplesAndCurveToScale) {
  const auto lines = terminal_plot(half_circle(), circle_answer(), 60, 11);
  ASSERT_THAT(lines, SizeIs(11));
  EXPECT_EQ(lines.back(), "part, object 3: 40 x 40 mm");
  // A circle that fills the height: the upper half was touched, the lower one is the curve's.
  EXPECT_THAT(lines[0], HasSubstr("\033[36m"));
  EXPECT_THAT(lines[9], testing::Not(HasSubstr("\033[36m")));
  EXPECT_GE(marks(lines[9]), 4U);
  // Round: ten rows of four dots are as wide as twenty characters of two.
  for (const std::string& line : lines) {
    const std::size_t first = line.find_first_not_of(' ');
    if (&line != &lines.back()) {
      EXPECT_GE(first, 19U) << line;
    }
  }
}

TEST(TerminalPlot, WithoutAnAnswerShowsTheSamples) {
  const auto lines = terminal_plot(half_circle(), {}, 60, 11);
  ASSERT_THAT(lines, SizeIs(11));
  EXPECT_EQ(lines.back(), "part, object 3: 40 x 20 mm");
}

TEST(TerminalPlot, IsEmptyWithoutRoomOrAnythingToShow) {
  EXPECT_THAT(terminal_plot({}, circle_answer(), 60, 11), IsEmpty());
  EXPECT_THAT(terminal_plot(half_circle(), circle_answer(), 2, 11), IsEmpty());
  EXPECT_THAT(terminal_plot(half_circle(), circle_answer(), 60, 0), IsEmpty());
}

TEST(TerminalPlot, ShowsNamesWithoutControlCharacters) {
  ContactGroup group = half_circle();
  group.name = "a\033[2J";
  EXPECT_THAT(terminal_plot(group, {}, 60, 11).back(), HasSubstr("a\\x1b[2J"));
}

}  // namespace
}  // namespace palpate
