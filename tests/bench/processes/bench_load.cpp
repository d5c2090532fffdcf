// The node under load: batches of 50 samples from 1 to 64 probes, at rates up to and beyond what it
// can process; with one node, or with two that share the probes by name prefix. Prints CSV:
// messages offered, accepted and missing, number of recognitions, and CPU time and memory of the
// nodes.
#include <cstdio>
#include <memory>
#include <string>
#include <thread>
#include <vector>

#include "node/client/contact_publisher.h"
#include "node/client/result_subscriber.h"
#include "tests/bench/options/bench_options.h"
#include "tests/bench/processes/node_process.h"

namespace {

using namespace palpate;
using namespace palpate::bench;

constexpr int kSamplesPerBatch = 50;
constexpr int kBatchesPerObject = 12;

struct Load {
  double samples_per_s;
  int probes;
  int nodes;
};

/// Alternately "east" and "west", so that two nodes have half of the probes each.
std::string name_of(int probe) {
  return (probe % 2 == 0 ? "east" : "west") + std::to_string(probe);
}

struct Side {
  std::unique_ptr<NodeProcess> node;
  std::unique_ptr<client::ResultSubscriber> results;
  double cpu_before_s = 0.0;
  v1::NodeStatus last;
};

bool run(const Load& load, double seconds, const std::string& folder) {
  client::ContactPublisherOptions publication;
  publication.endpoint = "bind:ipc://" + folder + "/contacts";
  client::ContactPublisher publisher(publication);
  std::vector<Side> sides(static_cast<std::size_t>(load.nodes));
  for (std::size_t i = 0; i < sides.size(); ++i) {
    const std::string results = "ipc://" + folder + "/results" + std::to_string(i);
    std::vector<std::string> further{"--max-groups", "64", "--status-period-s", "0.2"};
    if (load.nodes > 1) {
      further.insert(further.end(), {"--probe-prefixes", i == 0 ? "east" : "west"});
    }
    sides[i].node =
        std::make_unique<NodeProcess>("connect:ipc://" + folder + "/contacts", results, further);
    client::ResultSubscriberOptions subscription;
    subscription.endpoint = results;
    subscription.status = true;
    sides[i].results = std::make_unique<client::ResultSubscriber>(subscription);
    // A node's first status shows that it runs and has subscribed.
    const auto deadline = Clock::now() + std::chrono::seconds(10);
    while (sides[i].results->receive(std::chrono::milliseconds(100)).status == nullptr) {
      if (Clock::now() > deadline) return false;
    }
  }
  if (!publisher.wait_for_recognizer(std::chrono::seconds(10))) return false;
  std::this_thread::sleep_for(std::chrono::milliseconds(200));
  for (Side& side : sides) side.cpu_before_s = side.node->cpu_seconds();

  const auto batches = static_cast<std::int64_t>(seconds * load.samples_per_s / kSamplesPerBatch);
  const auto start = Clock::now();
  for (std::int64_t i = 0; i < batches; ++i) {
    const int probe = static_cast<int>(i % load.probes);
    const std::int64_t turn = i / load.probes;
    v1::ContactBatch batch =
        batch_of(kSamplesPerBatch * static_cast<int>(turn % kBatchesPerObject), kSamplesPerBatch,
                 static_cast<std::uint64_t>(1 + turn / kBatchesPerObject));
    const auto due = std::chrono::duration<double>(static_cast<double>(i) * kSamplesPerBatch /
                                                   load.samples_per_s);
    std::this_thread::sleep_until(start + std::chrono::duration_cast<Clock::duration>(due));
    publisher.publish(name_of(probe), batch);
  }
  const double taken_s = std::chrono::duration<double>(Clock::now() - start).count();
  double cpu_s = 0.0;
  double resident = 0.0;
  for (Side& side : sides) {
    cpu_s += side.node->cpu_seconds() - side.cpu_before_s;
    resident = std::max(resident, side.node->resident_bytes());
  }
  std::uint64_t taken = 0;
  std::uint64_t recognitions = 0;
  for (Side& side : sides) {
    const auto end = Clock::now() + std::chrono::seconds(2);
    while (Clock::now() < end) {
      const client::ReceivedResult result = side.results->receive(std::chrono::milliseconds(50));
      if (result.status != nullptr) side.last = *result.status;
    }
    taken += side.last.messages_received();
    recognitions += side.last.recognitions_published();
  }
  const double rate = static_cast<double>(batches) * kSamplesPerBatch / taken_s;
  std::printf("%.0f,%.0f,%d,%d,%lld,%llu,%lld,%llu,%.3f,%.2f,%.1f\n", load.samples_per_s, rate,
              load.probes, load.nodes, static_cast<long long>(batches),
              static_cast<unsigned long long>(taken),
              static_cast<long long>(batches) - static_cast<long long>(taken),
              static_cast<unsigned long long>(recognitions), cpu_s / taken_s,
              1e3 * cpu_s / taken_s / (rate / 1e3), resident / 1e6);
  std::fflush(stdout);
  return true;
}

}  // namespace

int main(int argc, char** argv) {
  double seconds = 4.0;
  if (const auto end = bench::BenchOptions("Load on palpate-node: rates, probes, two nodes")
                           .number("--seconds", seconds, "Of each load")
                           .parse(argc, argv)) {
    return *end;
  }
  std::printf(
      "offered_samples_per_s,sent_samples_per_s,probes,nodes,messages_sent,messages_taken,messages_"
      "missing,"
      "recognitions,cores_used,cpu_ms_per_1000_samples,resident_mb\n");
  std::fflush(stdout);
  std::vector<Load> loads;
  for (const double rate : {1e3, 1e4, 5e4, 1e5, 2e5, 4e5, 8e5, 1.6e6, 3.2e6})
    loads.push_back({rate, 1, 1});
  for (const int probes : {2, 4, 8, 16, 32, 64}) loads.push_back({2e4, probes, 1});
  for (const int probes : {2, 16, 64}) loads.push_back({2e4, probes, 2});
  for (const Load& load : loads) {
    const TemporaryFolder folder;
    if (!run(load, seconds, folder.path())) {
      std::fprintf(stderr, "bench_load: the node did not come up\n");
      return 1;
    }
  }
  return 0;
}
