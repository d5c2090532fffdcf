// The process tests' twin within one process, for the thread sanitizer: node, probes and planners
// as threads.
#include <gtest/gtest.h>

#include <atomic>
#include <cmath>
#include <thread>
#include <vector>

#include "node/client/contact_publisher.h"
#include "node/client/result_subscriber.h"
#include "node/config.h"
#include "node/node.h"
#include "node/process/bell.h"

namespace palpate {
namespace {

void stroke(client::ContactPublisher& publisher, const std::string& name, std::uint64_t object) {
  v1::ContactBatch batch;
  batch.set_object(object);
  for (int i = 0; i < 200; ++i) {
    v1::ContactSample& sample = *batch.add_samples();
    const double wobble = 2e-5 * std::sin(12.9898 * i);
    sample.set_x_m((0.02 + wobble) * std::cos(0.01 * i));
    sample.set_y_m((0.02 + wobble) * std::sin(0.01 * i));
    sample.set_sigma_m(2e-5);
    if (batch.samples_size() == 10) {
      ASSERT_TRUE(publisher.publish(name, batch));
      batch.clear_samples();
    }
  }
}

TEST(Twin, NodeProbesAndPlannersShareNothing) {
  NodeOptions options;
  options.contacts = {"tcp://127.0.0.1:*"};
  options.results = {"tcp://127.0.0.1:*"};
  options.status_period_s = 0.1;
  Node node(options, NodeKeys{});
  const std::string contacts = node.contacts_address();
  const std::string results = node.results_address();
  const Bell stop(Bell::Hearing::AtOnce);
  std::jthread server([&] { node.run(stop.fd()); });

  constexpr int kProbes = 3;
  constexpr std::uint64_t kObjects = 5;
  std::atomic<int> answered = 0;
  std::atomic<int> estimates = 0;
  std::vector<std::jthread> threads;
  for (int p = 0; p < kProbes; ++p) {
    threads.emplace_back([&, p] {
      const std::string name = "probe" + std::to_string(p);
      client::ResultSubscriberOptions subscription;
      subscription.endpoint = results;
      subscription.groups = {name};
      subscription.estimates = true;
      client::ResultSubscriber planner(subscription);
      client::ContactPublisherOptions publication;
      publication.endpoint = contacts;
      client::ContactPublisher publisher(publication);
      ASSERT_TRUE(publisher.wait_for_recognizer(std::chrono::seconds(10)));
      for (std::uint64_t object = 1; object <= kObjects; ++object) {
        stroke(publisher, name, object);
        for (bool done = false; !done;) {
          const client::ReceivedResult result = planner.receive(std::chrono::seconds(20));
          if (result.estimate != nullptr) {
            ++estimates;
            continue;
          }
          ASSERT_NE(result.recognition, nullptr) << name << ", object " << object;
          done =
              result.recognition->object() == object && result.recognition->sample_count() == 200;
        }
        ++answered;
      }
    });
  }
  threads.clear();
  stop.ring();
  EXPECT_EQ(answered.load(), kProbes * static_cast<int>(kObjects));
  EXPECT_GT(estimates.load(), 0);
}

}  // namespace
}  // namespace palpate
