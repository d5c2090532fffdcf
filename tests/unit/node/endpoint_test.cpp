#include "node/wire/endpoint.h"

#include <gmock/gmock.h>
#include <gtest/gtest.h>

namespace palpate {
namespace {

TEST(Endpoint, WhatIsAPortAndWhatIsNone) {
  for (const char* good : {"tcp://127.0.0.1:5581", "bind:tcp://127.0.0.1:*", "tcp://[::1]:0",
                           "connect:tcp://node.example:65535", "ipc:///run/99999"}) {
    EXPECT_TRUE(parse_endpoint(good, true)) << good;
  }
  for (const char* bad : {"tcp://127.0.0.1:99999", "tcp://127.0.0.1:65536", "tcp://127.0.0.1:-1",
                          "tcp://127.0.0.1:55a", "tcp://127.0.0.1:", "tcp://127.0.0.1"}) {
    const Result<Endpoint> endpoint = parse_endpoint(bad, true);
    EXPECT_FALSE(endpoint) << bad;
    EXPECT_THAT(endpoint.error, testing::HasSubstr("port")) << bad;
  }
}

// Nobody else is in the process, so nobody could ever connect.
TEST(Endpoint, WithinTheProcessNobodyListens) {
  for (const char* bad : {"inproc://x", "bind:inproc://x", "connect:inproc://x"}) {
    const Result<Endpoint> endpoint = parse_endpoint(bad, true);
    EXPECT_FALSE(endpoint) << bad;
    EXPECT_THAT(endpoint.error, testing::HasSubstr("reaches only within one process")) << bad;
  }
}

}  // namespace
}  // namespace palpate
