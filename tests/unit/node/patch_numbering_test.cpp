#include "node/intake/patch_numbering.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <vector>

namespace palpate {
namespace {

constexpr double kBreak = 10.0;
constexpr double kSpacing = 1e-3;

std::vector<ContactSample> samples_from(double x, int count = 10) {
  std::vector<ContactSample> samples;
  for (int i = 0; i < count; ++i) samples.push_back({Vec2(x + kSpacing * i, 0.0), 0.0, 0});
  return samples;
}

TEST(PatchNumbering, OneWirePatchIsOneRun) {
  PatchNumbering numbering;
  const std::uint32_t run = numbering.run_of(4, false, kBreak, samples_from(0.0));
  EXPECT_EQ(numbering.run_of(4, false, kBreak, samples_from(0.01)), run);
  // Without loss the probe's word counts, whatever the distance.
  EXPECT_EQ(numbering.run_of(4, false, kBreak, samples_from(1.0)), run);
  EXPECT_EQ(numbering.wire_patch(run), 4U);
}

TEST(PatchNumbering, AnotherNumberIsAnotherRunEvenIfSeenBefore) {
  PatchNumbering numbering;
  const std::uint32_t first = numbering.run_of(0, false, kBreak, samples_from(0.0));
  const std::uint32_t second = numbering.run_of(1, false, kBreak, samples_from(0.01));
  const std::uint32_t third = numbering.run_of(0, false, kBreak, samples_from(0.02));
  EXPECT_NE(first, second);
  EXPECT_NE(first, third);
  EXPECT_EQ(numbering.wire_patch(third), 0U);
}

TEST(PatchNumbering, ALossBreaksTheArcOnlyWhereTheHoleIsWide) {
  PatchNumbering numbering;
  const std::uint32_t run = numbering.run_of(0, false, kBreak, samples_from(0.0));
  // Last sample at 9 mm; 10 spacings of 1 mm are allowed.
  EXPECT_EQ(numbering.run_of(0, true, kBreak, samples_from(0.0189)), run);
  EXPECT_NE(numbering.run_of(0, true, kBreak, samples_from(0.0279 + 0.0101)), run);
}

TEST(PatchNumbering, AnEndedRunIsNotContinued) {
  PatchNumbering numbering;
  const std::uint32_t run = numbering.run_of(0, false, kBreak, samples_from(0.0));
  numbering.end_run();
  EXPECT_NE(numbering.run_of(0, false, kBreak, samples_from(0.01)), run);
}

TEST(PatchNumbering, OldRunsAreForgottenAndNewOnesKept) {
  PatchNumbering numbering;
  constexpr std::uint32_t kMany = 10000;
  constexpr std::uint32_t kOfOneRecognition = 1024;  // touches
  std::uint32_t run = 0;
  for (std::uint32_t patch = 0; patch < kMany; ++patch) {
    run = numbering.run_of(patch, false, kBreak, samples_from(0.0, 1));
    ASSERT_EQ(numbering.wire_patch(run), patch);
  }
  EXPECT_EQ(numbering.wire_patch(run - kOfOneRecognition), kMany - 1 - kOfOneRecognition);
  EXPECT_FALSE(numbering.wire_patch(run - kMany / 2));
  EXPECT_FALSE(numbering.wire_patch(run + 1));
}

TEST(PatchNumbering, StrokesAndTouchesAreForgottenEachByTheirOwnNumber) {
  constexpr std::uint32_t kMany = 10000;
  PatchNumbering numbering;
  const std::uint32_t stroke = numbering.run_of(77, false, kBreak, samples_from(0.0));
  const std::uint32_t still = numbering.run_of(78, false, kBreak, samples_from(1.0, 1));
  EXPECT_EQ(numbering.run_of(78, false, kBreak, samples_from(1.0, 1)), still);
  std::uint32_t touch = 0;
  for (std::uint32_t patch = 0; patch < kMany; ++patch) {
    touch = numbering.run_of(100 + patch, false, kBreak, samples_from(0.0, 1));
  }
  EXPECT_EQ(numbering.wire_patch(stroke), 77U);
  EXPECT_EQ(numbering.wire_patch(still), 78U);
  for (std::uint32_t patch = 0; patch < kMany; ++patch) {
    numbering.run_of(patch, false, kBreak, samples_from(0.0, 2));
  }
  EXPECT_EQ(numbering.wire_patch(touch), 100 + kMany - 1);
  EXPECT_EQ(numbering.wire_patch(still), 78U);
  EXPECT_FALSE(numbering.wire_patch(stroke));
}

}  // namespace
}  // namespace palpate
