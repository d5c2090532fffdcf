#include "node/client/result_decoder.h"

#include <gtest/gtest.h>

#include <chrono>
#include <string>

#include "node/wire/topics.h"

namespace palpate::client {
namespace {

using std::chrono::seconds;

class ManyTopics : public ::testing::Test {
 protected:
  static constexpr std::size_t kMost = 10;

  bool is_news(const std::string& group, std::uint64_t seq = 0) {
    v1::Recognition recognition;
    recognition.mutable_header()->set_epoch(1);
    recognition.mutable_header()->set_seq(seq);
    const std::string topic = make_topic(TopicKind::Recognition, group);
    return static_cast<bool>(decoder_.take(topic, recognition.SerializeAsString(), now_));
  }

  ResultDecoder decoder_{kMost};
  SteadyTime now_{seconds(1000)};
};

TEST_F(ManyTopics, AGroupForEachPartIsHeardForEver) {
  for (int part = 0; part < 100; ++part) {
    EXPECT_TRUE(is_news("part" + std::to_string(part))) << part;
    EXPECT_TRUE(is_news("line", static_cast<std::uint64_t>(part)));
    now_ += seconds(2);
  }
  EXPECT_EQ(decoder_.groups().size(), kMost);
  EXPECT_NE(decoder_.latest("line"), nullptr);
  EXPECT_NE(decoder_.latest("part99"), nullptr);
  EXPECT_EQ(decoder_.latest("part0"), nullptr);
  EXPECT_EQ(decoder_.counters().malformed, 0U);
  EXPECT_EQ(decoder_.counters().over_bound, 0U);
}

TEST_F(ManyTopics, WhatIsStillRepeatedStaysKnown) {
  for (std::size_t i = 0; i < kMost; ++i) EXPECT_TRUE(is_news(std::to_string(i)));
  now_ += seconds(5);
  EXPECT_FALSE(is_news("another"));
  EXPECT_EQ(decoder_.counters().over_bound, 1U);
  EXPECT_EQ(decoder_.counters().malformed, 0U);
  for (std::size_t i = 0; i < kMost; ++i) EXPECT_FALSE(is_news(std::to_string(i)));
  EXPECT_EQ(decoder_.counters().duplicates, kMost);
}

TEST_F(ManyTopics, WhatCannotBeReadTakesNoGroupsPlace) {
  for (std::size_t i = 0; i < kMost; ++i) EXPECT_TRUE(is_news(std::to_string(i)));
  now_ += seconds(60);
  EXPECT_FALSE(decoder_.take(make_topic(TopicKind::Recognition, "another"), "nonsense", now_));
  EXPECT_EQ(decoder_.groups().size(), kMost);
  EXPECT_EQ(decoder_.counters().malformed, 1U);
  EXPECT_EQ(decoder_.counters().over_bound, 0U);
}

TEST(ResultDecoder, AnEmptySourceIsTheTopics) {
  ResultDecoder decoder(10);
  v1::ContactBatch batch;
  batch.mutable_header()->set_epoch(1);
  const std::string topic = make_topic(TopicKind::Contact, "finger");
  ReceivedResult result = decoder.take(topic, batch.SerializeAsString());
  ASSERT_NE(result.contact, nullptr);
  EXPECT_EQ(result.contact->header().source(), "finger");
  v1::NodeStatus status;
  status.mutable_header()->set_epoch(1);
  result = decoder.take(make_topic(TopicKind::Status, "node"), status.SerializeAsString());
  ASSERT_NE(result.status, nullptr);
  EXPECT_EQ(result.status->header().source(), "node");
}

}  // namespace
}  // namespace palpate::client
