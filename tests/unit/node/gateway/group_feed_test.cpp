#include "node/gateway/place/group_feed.h"

#include <gtest/gtest.h>

namespace palpate::gateway {
namespace {

FedContact contact(std::uint64_t stream_seq, std::uint64_t object, std::uint64_t seq,
                   bool is_new = true) {
  FedContact made;
  made.stream_seq = stream_seq;
  made.is_new = is_new;
  made.probe = "finger";
  made.epoch = 1;
  made.seq = seq;
  made.object = object;
  made.payload = "0123456789";
  made.bytes = made.payload.size();
  return made;
}

/// Gives all that may be given, and the node takes it.
void give_all(GroupFeed& feed) {
  while (const FedContact* next = feed.next()) {
    const std::uint64_t stream_seq = next->stream_seq;
    feed.given();
    feed.accepted(stream_seq);
  }
}

TEST(GroupFeed, AnAnswerHoldsAllUpToItsNewestContact) {
  GroupFeed feed;
  for (std::uint64_t i = 0; i < 3; ++i) feed.add(contact(10 + 2 * i, 1, i));
  give_all(feed);
  EXPECT_EQ(feed.in_flight_bytes(), 30U);
  const auto first = feed.answered("finger", 1, 1);
  ASSERT_TRUE(first);
  EXPECT_EQ(first->from, 10U);
  EXPECT_EQ(first->through, 12U);
  EXPECT_EQ(first->begin, 10U);
  EXPECT_EQ(first->contacts, 2U);
  EXPECT_FALSE(feed.answered("finger", 1, 1));  // the node repeats itself
  const auto second = feed.answered("finger", 1, 2);
  ASSERT_TRUE(second);
  EXPECT_EQ(second->from, 14U);
  EXPECT_EQ(second->begin, 10U);
  EXPECT_EQ(feed.in_flight_count(), 0U);
  EXPECT_EQ(feed.in_flight_bytes(), 0U);
}

TEST(GroupFeed, ANewObjectWaitsUntilTheOldOneIsAnswered) {
  GroupFeed feed;
  feed.add(contact(1, 1, 0));
  feed.add(contact(2, 2, 1));
  give_all(feed);
  EXPECT_EQ(feed.in_flight_count(), 1U);
  ASSERT_TRUE(feed.answered("finger", 1, 0));
  give_all(feed);
  const auto span = feed.answered("finger", 1, 1);
  ASSERT_TRUE(span);
  EXPECT_EQ(span->begin, 2U);
  EXPECT_EQ(span->object, 2U);
}

TEST(GroupFeed, WhatIsReplayedIsNotAnsweredAgain) {
  GroupFeed feed;
  feed.add(contact(5, 1, 0, false));
  feed.add(contact(6, 1, 1, false));
  feed.add(contact(9, 1, 2));
  give_all(feed);
  EXPECT_FALSE(feed.answered("finger", 1, 0));
  const auto span = feed.answered("finger", 1, 2);
  ASSERT_TRUE(span);
  EXPECT_EQ(span->from, 9U);
  EXPECT_EQ(span->through, 9U);
  EXPECT_EQ(span->begin, 5U);
  EXPECT_EQ(span->contacts, 1U);
}

TEST(GroupFeed, ARejectedContactLeavesAndHoldsNobodyUp) {
  GroupFeed feed;
  feed.add(contact(1, 1, 0));
  feed.add(contact(2, 1, 0));  // of the same number: an answer could not be told from the first's
  feed.add(contact(3, 1, 1));
  ASSERT_NE(feed.next(), nullptr);
  feed.given();
  feed.accepted(1);
  EXPECT_EQ(feed.next(), nullptr);
  ASSERT_TRUE(feed.answered("finger", 1, 0));
  ASSERT_NE(feed.next(), nullptr);
  feed.given();
  const auto out = feed.rejected(2);
  ASSERT_TRUE(out);
  EXPECT_EQ(out->stream_seq, 2U);
  EXPECT_FALSE(feed.rejected(2));
  give_all(feed);
  const auto span = feed.answered("finger", 1, 1);
  ASSERT_TRUE(span);
  EXPECT_EQ(span->from, 3U);
  EXPECT_EQ(span->begin, 1U);
}

TEST(GroupFeed, NoMoreAreInFlightThanTheNodeLetsWait) {
  GroupFeed feed;
  for (std::uint64_t i = 0; i < 100; ++i) feed.add(contact(i + 1, 1, i));
  give_all(feed);
  EXPECT_EQ(feed.in_flight_count(), 32U);
  ASSERT_TRUE(feed.answered("finger", 1, 31));
  give_all(feed);
  EXPECT_EQ(feed.in_flight_count(), 32U);
}

}  // namespace
}  // namespace palpate::gateway
