// The counted work of an answer is bounded, whatever the input, and an answer that it was not
// enough for says so. Nothing here is timed: `bench_worst_case` tells what the counts take.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <random>
#include <span>
#include <string>
#include <vector>

#include "core/recognition/recognizer.h"
#include "core/recognition/samples/work_limit.h"
#include "core/recognition/smooth/arcs.h"
#include "core/recognition/weigh/weigh.h"
#include "tests/bench/worst_case/csv_input.h"
#include "tests/bench/worst_case/touched_input.h"
#include "tests/support/answer_invariants.h"
#include "tests/support/test_rng.h"

namespace palpate {
namespace {

using bench::TouchedInput;

/// Cold, and once more from the answer before: both answers.
std::vector<Recognition> answers_to(const TouchedInput& input) {
  Recognizer recognizer;
  for (const bench::TouchedPatch& patch : input) {
    recognizer.add(patch.context, patch.samples);
  }
  std::vector<Recognition> answers{recognizer.recognize()};
  answers.push_back(recognizer.recognize());
  return answers;
}

std::vector<Vec2> positions_of(const TouchedInput& input) {
  std::vector<Vec2> positions;
  for (const bench::TouchedPatch& patch : input) {
    for (const ContactSample& sample : patch.samples) {
      positions.push_back(sample.position_m);
    }
  }
  return positions;
}

/// How many of the answers to it were cut.
int expect_bounded(const TouchedInput& input, const std::string& name) {
  int cut = 0;
  for (const Recognition& answer : answers_to(input)) {
    EXPECT_EQ(test::broken_invariant(answer, test::places_of(positions_of(input))), "") << name;
    EXPECT_LE(answer.work.spent(), answer.work.most()) << name;
    if (answer.work.was_cut() && answer.status != RecognitionStatus::Collecting) {
      ++cut;
      EXPECT_EQ(answer.status, RecognitionStatus::Ambiguous) << name;
      EXPECT_EQ(answer.doubt, Doubt::WorkLimit) << name;
      EXPECT_FALSE(answer.hypotheses.empty()) << name;
    }
  }
  return cut;
}

TEST(BoundedWork, HoldsForTheDearestInputsKnown) {
  int cut = 0;
  for (const auto& entry : std::filesystem::directory_iterator(PALPATE_TEST_DATA "/hostile")) {
    if (entry.path().extension() == ".csv") {
      const auto input = bench::input_from(entry.path().string());
      ASSERT_TRUE(input.has_value()) << entry.path();
      cut += expect_bounded(*input, entry.path().filename().string());
    }
  }
  EXPECT_GT(cut, 0) << "no answer shows what is said of one that was cut";
}

TEST(BoundedWork, HoldsForRandomInputs) {
  constexpr std::size_t kMostSamples = 1000;
  std::mt19937_64 rng(2026);
  const int scenes = test::stress_count(200);
  for (int i = 0; i < scenes; ++i) {
    const bench::InputRecipe recipe =
        bench::random_recipe(rng, bench::InputKind::Any, kMostSamples);
    expect_bounded(bench::input_of(recipe), bench::to_text(recipe));
  }
}

/// What is told of the work of a clean ellipse is to be what one takes: a fifth off for most sizes,
/// or half again where chance sets a sample aside, which all is weighed again for.
TEST(BoundedWork, OfACleanEllipseIsWhatItIsSaidToBe) {
  constexpr double kOff = 1.5;
  for (const std::size_t patches : {1, 3, 8, 24, 64}) {
    for (const std::size_t samples : {32, 128, 512}) {
      const TouchedInput like(patches, {{}, std::vector<ContactSample>(samples)});
      const Recognition answer = answers_to(bench::clean_ellipse_like(like)).front();
      const double told = work_of_clean_ellipse(patches * samples, patches);
      EXPECT_FALSE(answer.work.was_cut());
      EXPECT_LT(answer.work.spent(), kOff * told) << patches << " x " << samples;
      EXPECT_GT(answer.work.spent(), told / kOff) << patches << " x " << samples;
    }
  }
}

/// The answer after the last samples of the last patch, from the one before.
Recognition last_update(const TouchedInput& input) {
  constexpr std::size_t kLast = 5;
  Recognizer recognizer;
  for (const bench::TouchedPatch& patch : input) {
    const std::size_t last = &patch == &input.back() ? kLast : 0;
    recognizer.add(patch.context, std::span(patch.samples).first(patch.samples.size() - last));
  }
  recognizer.recognize();
  recognizer.add(input.back().context, std::span(input.back().samples).last(kLast));
  return recognizer.recognize();
}

/// A sample off its neighbours by more than their noise, though not by more than is stated, is
/// taken for a spike, and taken back once the ellipse is known: once, not with each update.
TEST(BoundedWork, AStreamWeighsASampleThatIsTakenBackOnce) {
  TouchedInput input = bench::clean_ellipse_like({8, {{}, std::vector<ContactSample>(111)}});
  for (bench::TouchedPatch& patch : input) {
    for (ContactSample& sample : patch.samples) {
      sample.sigma_m *= 4.0;
    }
  }
  const Recognition without = last_update(input);
  ContactSample& off = input.front().samples[50];
  const Vec2 along = input.front().samples[60].position_m - input.front().samples[40].position_m;
  off.position_m += 3.0 * off.sigma_m * left_of(along.normalized());
  const Recognition with = last_update(input);
  EXPECT_EQ(with.status, RecognitionStatus::Recognized);
  EXPECT_EQ(with.outlier_count, 0U);
  EXPECT_LT(with.work.spent(), 1.2 * without.work.spent());
}

/// A single touch that errs grossly is set aside once the ellipse is known: once, not with each
/// update.
TEST(BoundedWork, AStreamWeighsASampleThatIsSetAsideOnce) {
  TouchedInput like(8, {{}, std::vector<ContactSample>(111)});
  like.insert(like.begin(), {{}, std::vector<ContactSample>(1)});
  TouchedInput input = bench::clean_ellipse_like(like);
  const Recognition without = last_update(input);
  ContactSample& off = input.front().samples.front();
  off.position_m *= 1.0 + 100.0 * off.sigma_m / off.position_m.norm();
  const Recognition with = last_update(input);
  EXPECT_EQ(with.status, RecognitionStatus::Recognized);
  EXPECT_EQ(with.outlier_count, 1U);
  EXPECT_LT(with.work.spent(), 1.2 * without.work.spent());
}

/// With nothing to spend, what is cheap is there all the same.
TEST(BoundedWork, SpentBeforeItBeginsLeavesLineAndCircle) {
  std::mt19937_64 rng(7);
  const TouchedInput like(3, {{}, std::vector<ContactSample>(60)});
  SampleMemory memory;
  for (const bench::TouchedPatch& patch : bench::clean_ellipse_like(like)) {
    memory.add(patch.context, patch.samples);
  }
  const FitData data = make_fit_data(memory.patches(), 0.0);
  WorkBudget work(0.0, 0.0);
  const Weighing w = weigh(data, memory.patches(), work);
  EXPECT_TRUE(work.was_cut());
  EXPECT_TRUE(w.fits[static_cast<std::size_t>(CurveClass::Line)].has_value());
  EXPECT_TRUE(w.fits[static_cast<std::size_t>(CurveClass::Circle)].has_value());
  double sum = 0.0;
  for (const double p : w.probabilities) {
    EXPECT_TRUE(std::isfinite(p));
    sum += p;
  }
  EXPECT_NEAR(sum, 1.0, 1e-9);
}

}  // namespace
}  // namespace palpate
