#include "node/tool/text/watch_table.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <limits>

namespace palpate {
namespace {

using testing::Each;
using testing::HasSubstr;
using testing::Not;
using testing::SizeIs;
using testing::StartsWith;

WatchedState state_of(int groups, int probes) {
  WatchedState state;
  state.has_status = true;
  for (int i = 0; i < groups; ++i) {
    WatchedGroup group;
    group.answer.set_status(v1::RECOGNITION_STATUS_RECOGNIZED);
    group.answer.set_curve_class(v1::CURVE_CLASS_CIRCLE);
    group.answer.mutable_parameters()->set_a(0.02);
    group.latency_ms = 1.24;
    state.groups["group-" + std::to_string(i)] = group;
  }
  for (int i = 0; i < probes; ++i) {
    v1::ProbeStatus& probe = *state.status.add_probes();
    probe.set_probe("probe-" + std::to_string(i));
    probe.set_alive(i % 2 == 0);
    probe.set_age_s(6.0);
  }
  return state;
}

TEST(WatchTable, ListsGroupsAndProbesAndTellsSilentOnes) {
  const auto lines = watch_table(state_of(1, 2), 200, 50);
  ASSERT_THAT(lines, SizeIs(6));
  EXPECT_THAT(lines[0], StartsWith("recognizer alive"));
  EXPECT_THAT(lines[2], StartsWith("group-0"));
  EXPECT_THAT(lines[2], HasSubstr("circle"));
  EXPECT_THAT(lines[2], HasSubstr("1.2 ms a 20 mm"));
  EXPECT_THAT(lines[4], HasSubstr("alive"));
  EXPECT_THAT(lines[5], HasSubstr("SILENT for 6.0 s"));
}

TEST(WatchTable, SaysWhatToDoNextWhereNothingIsRecognizedYet) {
  WatchedState state = state_of(1, 0);
  state.groups["group-0"].answer.set_status(v1::RECOGNITION_STATUS_AMBIGUOUS);
  state.groups["group-0"].answer.set_doubt(v1::RECOGNITION_DOUBT_RICHER_CLASS);
  state.groups["group-0"].answer.add_hypotheses()->set_curve_class(v1::CURVE_CLASS_ELLIPSE);
  const auto lines = watch_table(state, 200, 50);
  EXPECT_THAT(lines[3], HasSubstr("The samples do not exclude an ellipse: touch further round"));
}

TEST(WatchTable, SaysThatTheRecognizerIsSilent) {
  WatchedState state = state_of(1, 1);
  state.silent_s = 6.2;
  EXPECT_EQ(watch_table(state, 80, 24)[0], "recognizer silent for 6 s");
  EXPECT_EQ(watch_table({}, 80, 24)[0], "waiting for the recognizer");
}

TEST(WatchTable, SaysHowManyObjectsHaveNoAnswer) {
  WatchedState state = state_of(1, 1);
  EXPECT_THAT(watch_table(state, 200, 24)[0], Not(HasSubstr("without an answer")));
  state.status.set_objects_superseded(3);
  EXPECT_THAT(watch_table(state, 200, 24)[0], HasSubstr("; 3 objects without an answer"));
}

TEST(WatchTable, FitsTheTerminal) {
  for (const std::size_t columns : {20U, 80U, 300U}) {
    const auto lines = watch_table(state_of(30, 30), columns, 10);
    ASSERT_THAT(lines, SizeIs(10));
    EXPECT_THAT(lines, Each(SizeIs(testing::Le(columns))));
    // A shape that does not fit beside its group has a line of its own.
    EXPECT_EQ(lines.back(), columns < 80 ? "... 84 more lines" : "... 54 more lines");
  }
}

TEST(WatchTable, ShowsTheWholeShapeAndEveryColumnIn80Columns) {
  WatchedState state = state_of(1, 1);
  v1::Recognition& answer = state.groups["group-0"].answer;
  answer.set_curve_class(v1::CURVE_CLASS_ELLIPSE);
  answer.mutable_parameters()->set_b(0.01);
  answer.mutable_pose()->set_x_m(0.3);
  for (int i = 0; i < 25; ++i) answer.add_covariance(i % 6 == 0 ? 1e-12 : 0.0);
  const auto lines = watch_table(state, 80, 24);
  EXPECT_THAT(lines[3], HasSubstr("a 20.0000 +- 0.0010 mm, b 10.0000 +- 0.0010 mm, x 300"));
  EXPECT_THAT(lines[4], HasSubstr("RESTARTS"));
}

TEST(WatchTable, ShowsTheInvariantsByClass) {
  WatchedState state = state_of(1, 0);
  const auto add = [&](v1::CurveClass curve_class, const char* name, double value, double sigma) {
    v1::Invariant& invariant = *state.groups["group-0"].answer.add_invariants();
    invariant.set_curve_class(curve_class);
    invariant.set_name(name);
    invariant.set_value(value);
    invariant.set_sigma(sigma);
  };
  add(v1::CURVE_CLASS_ELLIPSE, "Ic1", 163.4, 16.0);
  add(v1::CURVE_CLASS_ELLIPSE, "Ic2", 28.3, 1.5);
  // Where a tolerance decides there is no deviation.
  add(v1::CURVE_CLASS_PARABOLA, "Ip", 4.25, std::numeric_limits<double>::infinity());
  const auto lines = watch_table(state, 200, 24);
  EXPECT_EQ(lines[3], "  ellipse Ic1 163 +- 16, Ic2 28.3 +- 1.5; parabola Ip 4.25");
}

TEST(WatchTable, ColumnsStandBelowTheirNamesWhateverTheObjectIsNumbered) {
  WatchedState state = state_of(1, 0);
  state.groups["group-0"].answer.set_object(1795416244610);  // by a clock
  const auto lines = watch_table(state, 200, 24);
  EXPECT_THAT(lines[2], HasSubstr(" ..44610 circle"));
  EXPECT_EQ(lines[2].find("circle"), lines[1].find("CLASS"));
}

TEST(WatchTable, ShowsNamesWithoutControlCharacters) {
  WatchedState state = state_of(0, 1);
  state.status.mutable_probes(0)->set_probe("a\033[2Jb\n");
  EXPECT_THAT(watch_table(state, 80, 24)[2], StartsWith("a\\x1b[2Jb\\x0a"));
}

}  // namespace
}  // namespace palpate
