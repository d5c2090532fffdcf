#include "node/tool/commands/live/topic_count.h"

#include <gtest/gtest.h>

#include <string>

#include "palpate/v1/node_status.pb.h"

namespace palpate {
namespace {

using Seconds = std::chrono::duration<double>;

TopicCount::Time at(double seconds) {
  return TopicCount::Time() +
         std::chrono::duration_cast<std::chrono::nanoseconds>(Seconds(seconds));
}

/// A message of the contract: only its header matters.
std::string message(std::uint64_t seq) {
  v1::NodeStatus status;
  status.mutable_header()->set_epoch(7);
  status.mutable_header()->set_seq(seq);
  return status.SerializeAsString();
}

TEST(TopicCount, TellsTheRateWhileMessagesCome) {
  TopicCount count;
  for (int i = 0; i <= 50; ++i) count.take(message(static_cast<std::uint64_t>(i) + 1), at(0.1 * i));
  EXPECT_NEAR(count.rate_hz(at(5.05)), 10.0, 1e-6);
  EXPECT_EQ(count.silence_s(at(5.05)), 0.0);
}

TEST(TopicCount, AfterThePublisherHasDiedShowsNoRateAndTheSilence) {
  TopicCount count;
  for (int i = 0; i <= 50; ++i) count.take(message(static_cast<std::uint64_t>(i) + 1), at(0.1 * i));
  EXPECT_EQ(count.rate_hz(at(9.0)), 0.0);
  EXPECT_NEAR(count.silence_s(at(9.0)), 4.0, 1e-6);
  count.take(message(52), at(9.1));
  EXPECT_GT(count.rate_hz(at(9.2)), 0.0);
  EXPECT_EQ(count.silence_s(at(9.2)), 0.0);
}

TEST(TopicCount, WaitsForTheNextMessageOfASlowTopic) {
  TopicCount count;
  for (int i = 0; i < 4; ++i) count.take(message(static_cast<std::uint64_t>(i) + 1), at(5.0 * i));
  EXPECT_NEAR(count.rate_hz(at(29.0)), 0.2, 1e-6);
  EXPECT_EQ(count.silence_s(at(29.0)), 0.0);
  EXPECT_EQ(count.rate_hz(at(31.0)), 0.0);
  EXPECT_NEAR(count.silence_s(at(31.0)), 16.0, 1e-6);
}

TEST(TopicCount, RepeatsAreNoRateButNoSilenceEither) {
  TopicCount count;
  for (int i = 0; i < 10; ++i) count.take(message(static_cast<std::uint64_t>(i) + 1), at(0.1 * i));
  for (int i = 1; i <= 9; ++i) count.take(message(10), at(i));
  EXPECT_EQ(count.repeats, 9U);
  EXPECT_EQ(count.rate_hz(at(9.5)), 0.0);
  EXPECT_EQ(count.silence_s(at(9.5)), 0.0);
  EXPECT_NEAR(count.silence_s(at(13.0)), 4.0, 1e-6);
}

TEST(TopicCount, OfNothingTellsNothing) {
  const TopicCount count;
  EXPECT_EQ(count.rate_hz(at(100.0)), 0.0);
  EXPECT_EQ(count.silence_s(at(100.0)), 0.0);
}

}  // namespace
}  // namespace palpate
