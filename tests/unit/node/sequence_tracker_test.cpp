#include "node/intake/sequence_tracker.h"

#include <gtest/gtest.h>

#include <cstdint>
#include <limits>

namespace palpate {
namespace {

constexpr std::uint64_t kEpoch = 7;

TEST(SequenceTracker, AStreamWithoutLossHasNoGaps) {
  SequenceTracker tracker;
  EXPECT_EQ(tracker.take(kEpoch, 0), SequenceEvent::First);
  for (std::uint64_t seq = 1; seq < 100; ++seq) {
    EXPECT_EQ(tracker.take(kEpoch, seq), SequenceEvent::Next);
  }
  EXPECT_EQ(tracker.gaps(), 0U);
  EXPECT_EQ(tracker.missing(), 0U);
  EXPECT_EQ(tracker.restarts(), 0U);
}

TEST(SequenceTracker, AGapIsCountedByItsLength) {
  SequenceTracker tracker;
  tracker.take(kEpoch, 10);  // joined late: nothing is missing that we should have heard
  EXPECT_EQ(tracker.missing(), 0U);
  EXPECT_EQ(tracker.take(kEpoch, 14), SequenceEvent::Gap);
  EXPECT_EQ(tracker.gaps(), 1U);
  EXPECT_EQ(tracker.missing(), 3U);
}

TEST(SequenceTracker, DuplicatesAndLateOnesAreNotNews) {
  SequenceTracker tracker;
  tracker.take(kEpoch, 5);
  EXPECT_EQ(tracker.take(kEpoch, 5), SequenceEvent::NotNewer);
  EXPECT_EQ(tracker.take(kEpoch, 3), SequenceEvent::NotNewer);
  EXPECT_EQ(tracker.seq(), 5U);
  EXPECT_EQ(tracker.missing(), 0U);
}

TEST(SequenceTracker, ARestartIsANewEpochAndTheOldOneIsStale) {
  SequenceTracker tracker;
  tracker.take(kEpoch, 50);
  EXPECT_EQ(tracker.take(kEpoch + 1, 2), SequenceEvent::Restart);
  EXPECT_EQ(tracker.restarts(), 1U);
  EXPECT_EQ(tracker.missing(), 2U);  // its 0 and 1
  EXPECT_EQ(tracker.take(kEpoch, 51), SequenceEvent::StaleEpoch);
  EXPECT_EQ(tracker.take(kEpoch + 1, 3), SequenceEvent::Next);
  EXPECT_EQ(tracker.restarts(), 1U);
}

TEST(SequenceTracker, JudgingTakesNothing) {
  SequenceTracker tracker;
  tracker.take(kEpoch, 1);
  EXPECT_EQ(tracker.judge(kEpoch, 9), SequenceEvent::Gap);
  EXPECT_EQ(tracker.take(kEpoch, 2), SequenceEvent::Next);
  EXPECT_EQ(tracker.missing(), 0U);
}

TEST(SequenceTracker, AWildNumberShutsNobodyOut) {
  constexpr std::uint64_t kLast = std::numeric_limits<std::uint64_t>::max();
  SequenceTracker tracker;
  tracker.take(kEpoch, 5);
  EXPECT_EQ(tracker.take(kEpoch, kLast), SequenceEvent::TooFarAhead);
  EXPECT_EQ(tracker.take(kEpoch, 6), SequenceEvent::Next);
  EXPECT_EQ(tracker.missing(), 0U);
  // Where it comes first, nobody can know; but it does not stay.
  SequenceTracker begun_badly;
  EXPECT_EQ(begun_badly.take(kEpoch, kLast), SequenceEvent::First);
  EXPECT_EQ(begun_badly.take(kEpoch, 0), SequenceEvent::Restart);
  EXPECT_EQ(begun_badly.take(kEpoch, 1), SequenceEvent::Next);
  EXPECT_EQ(begun_badly.take(kEpoch, kLast), SequenceEvent::TooFarAhead);
}

TEST(SequenceTracker, ASenderWithoutEpochsRestartsByCountingAnew) {
  SequenceTracker tracker;
  tracker.take(0, 50);
  EXPECT_EQ(tracker.take(0, 50), SequenceEvent::NotNewer);
  EXPECT_EQ(tracker.take(0, 0), SequenceEvent::Restart);
  EXPECT_EQ(tracker.take(0, 1), SequenceEvent::Next);
  EXPECT_EQ(tracker.restarts(), 1U);
  EXPECT_EQ(tracker.missing(), 0U);
}

}  // namespace
}  // namespace palpate
