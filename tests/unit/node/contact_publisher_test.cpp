#include "node/client/contact_publisher.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <chrono>
#include <optional>
#include <string>
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

TEST(ContactPublisher, WaitsAtItsEndForARecognizerThatIsBehind) {
  EXPECT_GE(end_of_publisher(milliseconds(400)), milliseconds(400));
}

TEST(ContactPublisher, DoesNotWaitLongerThanAsked) {
  EXPECT_LT(end_of_publisher(milliseconds(0)), milliseconds(400));
}

}  // namespace
}  // namespace palpate::client
