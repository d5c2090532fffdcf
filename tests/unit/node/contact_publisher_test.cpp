#include "node/client/contact_publisher.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <optional>
#include <string>
#include <vector>
#include <zmq.hpp>

namespace palpate::client {
namespace {

using std::chrono::milliseconds;

/// How long a publisher takes to end while a recognizer holds back far more than the system's
/// buffers hold.
std::chrono::nanoseconds end_of_publisher(std::optional<milliseconds> finish_within) {
  constexpr int kMessages = 20000;
  zmq::context_t context;
  zmq::socket_t recognizer(context, zmq::socket_type::sub);
  recognizer.set(zmq::sockopt::rcvhwm, 10);
  recognizer.set(zmq::sockopt::linger, 0);
  recognizer.set(zmq::sockopt::subscribe, "");
  ContactPublisherOptions options;
  options.endpoint = "ipc:///tmp/palpate-publisher-test-" + std::to_string(::getpid());
  options.high_water_mark = 2 * kMessages;
  recognizer.bind(options.endpoint);
  std::optional<ContactPublisher> publisher(options);
  // libzmq's reader accepts and subscribes while it is asked for something.
  while (!publisher->wait_for_recognizer(milliseconds(10))) {
    (void)recognizer.get(zmq::sockopt::events);
  }
  v1::ContactBatch batch;
  for (int i = 0; i < 10; ++i) batch.add_samples()->set_x_m(1e-3 * i);
  for (int i = 0; i < kMessages; ++i) EXPECT_TRUE(publisher->publish("finger", batch));
  if (finish_within) publisher->finish_within(*finish_within);
  const auto start = std::chrono::steady_clock::now();
  publisher.reset();
  return std::chrono::steady_clock::now() - start;
}

/// Where a recognizer that bounds its queue listens; it reads nothing unless it is told.
class FullQueue : public ::testing::Test {
 protected:
  static constexpr int kMost = 20000;  // messages; far more than the system's buffers hold
  static constexpr std::chrono::hours kForEver{1};

  FullQueue() {
    recognizer_.set(zmq::sockopt::rcvhwm, 10);
    recognizer_.set(zmq::sockopt::linger, 0);
    recognizer_.set(zmq::sockopt::subscribe, "");
    options_.endpoint = "ipc:///tmp/palpate-full-queue-test-" + std::to_string(::getpid());
    options_.high_water_mark = 10;
    recognizer_.bind(options_.endpoint);
    publisher_.emplace(options_);
    while (!publisher_->wait_for_recognizer(milliseconds(10))) {
      (void)recognizer_.get(zmq::sockopt::events);
    }
    for (int i = 0; i < 10; ++i) batch_.add_samples()->set_x_m(1e-3 * i);
  }

  /// Reads what has come, and expects it to be in order without a gap.
  void read() {
    TwoFrames message;
    v1::ContactBatch received;
    while (receive_now(recognizer_, message)) {
      ASSERT_TRUE(received.ParseFromString(std::string(view_of(message.payload))));
      ASSERT_EQ(received.header().seq(), next_seq_++);
    }
  }

  zmq::context_t context_;
  zmq::socket_t recognizer_{context_, zmq::socket_type::sub};
  ContactPublisherOptions options_;
  std::optional<ContactPublisher> publisher_;
  v1::ContactBatch batch_;
  std::uint64_t next_seq_ = 0;
};

TEST_F(FullQueue, RefusesWhatItHasNoRoomFor) {
  int taken = 0;
  while (taken < kMost && publisher_->publish("finger", batch_)) ++taken;
  EXPECT_LT(taken, kMost);
}

TEST_F(FullQueue, WaitsForRoomAndLosesNothing) {
  for (int i = 0; i < kMost; ++i) {
    ASSERT_TRUE(publisher_->publish_when_room("finger", batch_, kForEver, [&] {
      read();
      return false;
    }));
  }
  std::vector<zmq::pollitem_t> items{{recognizer_.handle(), 0, ZMQ_POLLIN, 0}};
  for (int silent = 0; next_seq_ < kMost && silent < 100;) {
    poll(items, 100);
    silent = items.front().revents == 0 ? silent + 1 : 0;
    read();
  }
  EXPECT_EQ(next_seq_, static_cast<std::uint64_t>(kMost));
}

TEST_F(FullQueue, GivesUpAfterTheLongestWait) {
  constexpr milliseconds kLongest{3};
  bool taken = true;
  std::chrono::nanoseconds waited{0};
  for (int i = 0; i < kMost && taken; ++i) {
    const auto start = std::chrono::steady_clock::now();
    taken = publisher_->publish_when_room("finger", batch_, kLongest, [] { return false; });
    waited = std::chrono::steady_clock::now() - start;
  }
  EXPECT_FALSE(taken);
  EXPECT_GE(waited, kLongest);
}

TEST_F(FullQueue, GivesUpWhenItIsTold) {
  bool given_up = false;
  for (int i = 0; i < kMost && !given_up; ++i) {
    int asked = 0;
    const bool taken =
        publisher_->publish_when_room("finger", batch_, kForEver, [&] { return ++asked == 3; });
    given_up = asked == 3;
    ASSERT_NE(taken, given_up);
  }
  EXPECT_TRUE(given_up);
}

TEST(ContactPublisher, WaitsAtItsEndForARecognizerThatIsBehind) {
  EXPECT_GE(end_of_publisher(milliseconds(400)), milliseconds(400));
}

TEST(ContactPublisher, DoesNotWaitLongerThanAsked) {
  EXPECT_LT(end_of_publisher(milliseconds(0)), milliseconds(400));
}

}  // namespace
}  // namespace palpate::client
