#include "node/wire/topics.h"

#include <gtest/gtest.h>

#include <string>

#include "node/wire/endpoint.h"

namespace palpate {
namespace {

TEST(Topics, BuiltTopicsParseBack) {
  for (const TopicKind kind :
       {TopicKind::Contact, TopicKind::Recognition, TopicKind::Estimate, TopicKind::Status}) {
    for (const std::string& name :
         {std::string("a"), std::string("Left-finger_2.b"), std::string(kMaxNameLength, 'x')}) {
      const std::string text = make_topic(kind, name);
      EXPECT_TRUE(text.starts_with(topic_prefix(kind)));
      const std::optional<Topic> topic = parse_topic(text);
      ASSERT_TRUE(topic) << text;
      EXPECT_EQ(topic->kind, kind);
      EXPECT_EQ(topic->name, name);
    }
  }
}

TEST(Topics, APrefixDoesNotCatchALongerName) {
  EXPECT_FALSE(make_topic(TopicKind::Contact, "probe10")
                   .starts_with(make_topic(TopicKind::Contact, "probe1")));
}

TEST(Topics, OthersAreRefused) {
  for (const std::string& text :
       {std::string(""), std::string("contact/"), std::string("contact//"),
        std::string("contact/a"), std::string("contact/a/b/"), std::string("contact/a b/"),
        std::string("Contact/a/"), std::string("contact/\xc3\xa9/"),
        std::string("contact/a\0/", 11), std::string("other/a/"),
        "contact/" + std::string(kMaxNameLength + 1, 'x') + "/"}) {
    EXPECT_FALSE(parse_topic(text)) << text;
  }
}

TEST(Endpoint, SideAndAddress) {
  EXPECT_EQ(to_string(*parse_endpoint("tcp://127.0.0.1:1", true).value), "bind:tcp://127.0.0.1:1");
  EXPECT_EQ(to_string(*parse_endpoint("tcp://127.0.0.1:1", false).value),
            "connect:tcp://127.0.0.1:1");
  EXPECT_EQ(to_string(*parse_endpoint("connect:ipc:///tmp/x", true).value), "connect:ipc:///tmp/x");
  EXPECT_EQ(to_string(*parse_endpoint("bind:ipc:///x", false).value), "bind:ipc:///x");
  for (const char* text :
       {"", "bind:", "tcp://", "127.0.0.1:1", "udp://127.0.0.1:1", "bind:bind:"}) {
    EXPECT_FALSE(parse_endpoint(text, true)) << text;
  }
}

TEST(Endpoint, WhatOnlyThisMachineReaches) {
  for (const char* text : {"tcp://127.0.0.1:1", "tcp://127.1.2.3:*", "tcp://localhost:1",
                           "tcp://[::1]:1", "tcp://lo:1", "ipc:///tmp/x"}) {
    EXPECT_TRUE(is_local(*parse_endpoint(text, true).value)) << text;
  }
  for (const char* text :
       {"tcp://*:1", "tcp://0.0.0.0:1", "tcp://[::]:1", "tcp://192.168.1.2:1", "tcp://eth0:1",
        "tcp://127.example.org:1", "tcp://localhost.example:1"}) {
    EXPECT_FALSE(is_local(*parse_endpoint(text, true).value)) << text;
  }
}

}  // namespace
}  // namespace palpate
