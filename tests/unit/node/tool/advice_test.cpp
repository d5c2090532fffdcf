#include "node/tool/text/advice.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

#include <utility>

namespace palpate {
namespace {

using testing::HasSubstr;
using testing::Not;

v1::Recognition doubted(v1::RecognitionDoubt doubt,
                        v1::CurveClass curve_class = v1::CURVE_CLASS_ELLIPSE) {
  v1::Recognition answer;
  answer.set_status(v1::RECOGNITION_STATUS_AMBIGUOUS);
  answer.set_doubt(doubt);
  answer.set_curve_class(curve_class);
  return answer;
}

TEST(Advice, AsksForNoSideThatWasStatedOrTellsNothing) {
  const v1::Recognition two = doubted(v1::RECOGNITION_DOUBT_TWO_SHAPES);
  EXPECT_THAT(advice_text(two), HasSubstr("touched_from"));
  EXPECT_THAT(advice_text(two, {.touched_from = true}), Not(HasSubstr("touched_from")));
  EXPECT_THAT(advice_text(two, {.touched_from = true}), HasSubstr("material side"));
  EXPECT_THAT(advice_text(two, {.tip_sides = true}), Not(HasSubstr("side")));
  // A line has neither outside nor inside, and is the same two wherever it is touched.
  const v1::Recognition line = doubted(v1::RECOGNITION_DOUBT_TWO_SHAPES, v1::CURVE_CLASS_LINE);
  for (const bool touched_from : {false, true}) {
    const std::string advice = advice_text(line, {.touched_from = touched_from});
    EXPECT_THAT(advice, Not(HasSubstr("touched_from")));
    EXPECT_THAT(advice, Not(HasSubstr("another place")));
    EXPECT_THAT(advice, HasSubstr("material side"));
  }
}

TEST(Advice, AsksForNoNoiseThatWasStated) {
  for (const v1::RecognitionDoubt doubt :
       {v1::RECOGNITION_DOUBT_FEW_PLACES, v1::RECOGNITION_DOUBT_WORK_LIMIT}) {
    EXPECT_THAT(advice_text(doubted(doubt)), HasSubstr("noise"));
    EXPECT_THAT(advice_text(doubted(doubt), {.noise = true}), Not(HasSubstr("noise")));
  }
  const v1::Recognition work = doubted(v1::RECOGNITION_DOUBT_WORK_LIMIT);
  EXPECT_THAT(advice_text(work, {.noise = true}), HasSubstr("material side"));
  EXPECT_THAT(advice_text(work, {.tip_sides = true}), Not(HasSubstr("side")));
  EXPECT_THAT(advice_text(work, {.noise = true, .tip_sides = true}), Not(HasSubstr("state")));
}

TEST(Advice, NamesTheLoosestParameterAndHowWellItIsKnown) {
  v1::Recognition answer = doubted(v1::RECOGNITION_DOUBT_UNDETERMINED);
  answer.mutable_parameters()->set_a(0.03);
  answer.mutable_parameters()->set_b(0.02);
  answer.mutable_pose();
  for (const auto& [sigma_m, words] :
       {std::pair(0.005, "(b is known to 25 % only)"), std::pair(0.03, "(b is not known)"),
        std::pair(6e5, "(b is not known)")}) {
    answer.clear_covariance();
    for (int i = 0; i < 25; ++i) answer.add_covariance(i == 6 ? sigma_m * sigma_m : 0.0);
    EXPECT_THAT(advice_text(answer), HasSubstr(words));
  }
}

TEST(Advice, SaysWhatToleranceWasStated) {
  const v1::Recognition form = doubted(v1::RECOGNITION_DOUBT_FORM_ERROR);
  EXPECT_THAT(advice_text(form), HasSubstr("Tell the recognizer"));
  EXPECT_THAT(advice_text(form, {.form_deviation_m = 1e-5}), Not(HasSubstr("Tell")));
  EXPECT_THAT(advice_text(form, {.form_deviation_m = 1e-5}),
              HasSubstr("stated form_deviation_m of 10 um"));
  v1::Recognition none;
  none.set_status(v1::RECOGNITION_STATUS_RECOGNIZED);
  none.set_curve_class(v1::CURVE_CLASS_UNCLASSIFIED);
  none.set_sigma_m(1e-5);
  v1::Hypothesis& unclassified = *none.add_hypotheses();
  unclassified.set_curve_class(v1::CURVE_CLASS_UNCLASSIFIED);
  unclassified.set_chi2(100.0);
  v1::Hypothesis& nearest = *none.add_hypotheses();
  nearest.set_curve_class(v1::CURVE_CLASS_CIRCLE);
  nearest.mutable_parameters();
  nearest.set_chi2(10000.0);
  nearest.set_dof(99);
  EXPECT_THAT(advice_text(none), HasSubstr("state it (form_deviation_m)"));
  EXPECT_THAT(advice_text(none, {.form_deviation_m = 1e-5}),
              HasSubstr("state more than 10 um (form_deviation_m)"));
}

}  // namespace
}  // namespace palpate
