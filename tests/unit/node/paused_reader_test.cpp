// A planner that does not read for longer than a heartbeat, while more comes than it lets wait.
#include <gtest/gtest.h>

#include <chrono>
#include <string>
#include <thread>

#include "node/client/result_subscriber.h"
#include "node/wire/socket.h"
#include "node/wire/topics.h"

namespace palpate {
namespace {

using std::chrono::milliseconds;

class PausedReader : public ::testing::TestWithParam<const char*> {};

// libzmq (4.3.4) aborts the process ("_input_stopped") where a heartbeat of the reading side
// expires while its queue is full, and the queue is emptied after the reconnection.
TEST_P(PausedReader, ReadsOnWhenItComesBack) {
  zmq::context_t context(1);
  zmq::socket_t publisher = make_socket(context, zmq::socket_type::xpub, {});
  publisher.bind(GetParam());
  client::ResultSubscriberOptions options;
  options.endpoint = publisher.get(zmq::sockopt::last_endpoint);
  options.high_water_mark = 20;
  client::ResultSubscriber planner(options);
  zmq::message_t subscription;
  ASSERT_TRUE(publisher.recv(subscription));

  v1::Recognition recognition;
  recognition.mutable_header()->set_epoch(1);
  const std::string topic = make_topic(TopicKind::Recognition, "cup");
  std::uint64_t seq = 0;
  const auto publish = [&] {
    recognition.mutable_header()->set_seq(seq++);
    send_now(publisher, topic, recognition.SerializeAsString());
  };
  for (int pause = 0; pause < 2; ++pause) {
    for (int i = 0; i < 500; ++i) publish();
    std::this_thread::sleep_for(milliseconds(1200));  // twice the heartbeat's timeout
    int waiting = 0;
    while (planner.receive(milliseconds(0)).recognition != nullptr) ++waiting;
    // The queue was full: its writer learns of room half a queue at a time.
    EXPECT_GE(waiting, options.high_water_mark / 2);
    // What comes next is read to its end, what the transport still held included, until it is up to
    // date.
    bool newest = false;
    for (int attempt = 0; attempt < 100 && !newest; ++attempt) {
      publish();
      while (const v1::Recognition* received = planner.receive(milliseconds(50)).recognition) {
        newest = received->header().seq() + 1 == seq;
      }
    }
    EXPECT_TRUE(newest);
  }
}

INSTANTIATE_TEST_SUITE_P(Transports, PausedReader,
                         ::testing::Values("tcp://127.0.0.1:*", "ipc://*"));

}  // namespace
}  // namespace palpate
