// Latency from publishing a batch to receiving the recognition that contains it, without the
// computing time. For comparison, in the same run: a bare two-hop ZeroMQ relay with equal message
// sizes, and a relay that keeps its core and cache busy for as long as the node computed. They take
// turns message by message, so that all see the same state of the machine. Prints CSV: transport,
// what, quantiles in microseconds.
#include <benchmark/benchmark.h>
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <string>
#include <thread>
#include <vector>
#include <zmq.hpp>

#include "node/client/contact_publisher.h"
#include "node/client/result_subscriber.h"
#include "node/wire/socket.h"
#include "tests/bench/options/bench_options.h"
#include "tests/bench/processes/node_process.h"

namespace {

using namespace palpate;
using namespace palpate::bench;

struct Endpoints {
  std::string in;
  std::string out;
};

/// What the relay should do with a message; stored in the first bytes of the message.
struct RelayOrder {
  std::uint64_t answer_bytes;
  std::int64_t busy_ns;
};

/// Memory that the busy relay walks through, so that its caches are as cold as after a recognition:
/// the size of a core's second-level cache.
constexpr std::size_t kWorkingSetBytes = std::size_t{1} << 20;

/// Forwards each message as one of the ordered size, after as much work as ordered.
[[noreturn]] void relay(const Endpoints& endpoints) {
  zmq::context_t context(1);
  zmq::socket_t in = make_socket(context, zmq::socket_type::sub, {});
  zmq::socket_t out = make_socket(context, zmq::socket_type::pub, {});
  in.set(zmq::sockopt::subscribe, "");
  in.bind(endpoints.in);
  out.bind(endpoints.out);
  TwoFrames message;
  std::string payload;
  std::vector<double> working_set(kWorkingSetBytes / sizeof(double));
  for (;;) {
    std::vector<zmq::pollitem_t> items{{in.handle(), 0, ZMQ_POLLIN, 0}};
    palpate::poll(items, -1);
    while (receive_now(in, message)) {
      RelayOrder order{};
      std::memcpy(&order, message.payload.data(), sizeof order);
      payload.resize(order.answer_bytes);
      const auto end = Clock::now() + std::chrono::nanoseconds(order.busy_ns);
      while (order.busy_ns > 0 && Clock::now() < end) {
        for (double& value : working_set) value += 1.0;
        benchmark::DoNotOptimize(working_set.data());
      }
      send_now(out, message.topic.to_string_view(), payload);
    }
  }
}

/// The same path through the relay: as many bytes in, as many out.
double through_relay(zmq::socket_t& to, zmq::socket_t& from, std::string payload,
                     const RelayOrder& order) {
  std::memcpy(payload.data(), &order, sizeof order);
  std::vector<zmq::pollitem_t> items{{from.handle(), 0, ZMQ_POLLIN, 0}};
  TwoFrames frames;
  const auto sent = Clock::now();
  send_now(to, "contact/probe/", payload);
  while (!receive_now(from, frames)) palpate::poll(items, 5000);
  return microseconds(Clock::now() - sent);
}

void print(const std::string& transport, const char* what, std::vector<double> values) {
  std::printf("%s,%s,%.1f,%.1f,%.1f,%.1f\n", transport.c_str(), what, quantile(values, 0.5),
              quantile(values, 0.9), quantile(values, 0.99), quantile(values, 1.0));
}

bool measure(const std::string& transport, const Endpoints& node, const Endpoints& bare,
             int rounds) {
  client::ContactPublisherOptions publication;
  publication.endpoint = node.in;
  client::ContactPublisher publisher(publication);
  client::ResultSubscriberOptions subscription;
  subscription.endpoint = node.out;
  client::ResultSubscriber subscriber(subscription);
  zmq::context_t context(1);
  zmq::socket_t to_relay = make_socket(context, zmq::socket_type::pub, {});
  zmq::socket_t from_relay = make_socket(context, zmq::socket_type::sub, {});
  from_relay.set(zmq::sockopt::subscribe, "");
  to_relay.connect(bare.in);
  from_relay.connect(bare.out);
  if (!publisher.wait_for_recognizer(std::chrono::seconds(10))) return false;
  std::this_thread::sleep_for(std::chrono::milliseconds(300));  // the relay's subscriptions
  std::vector<double> whole;
  std::vector<double> less_compute;
  std::vector<double> relayed;
  std::vector<double> busy_relayed;
  constexpr int kBatches = 20;  // per object
  constexpr int kSamples = 10;  // per batch
  constexpr int kWarmUp = 100;
  // The same pause before each of the three, because a core that has slept takes time to wake up.
  const auto pause = [] { std::this_thread::sleep_for(std::chrono::microseconds(500)); };
  for (int round = 0; round < rounds + kWarmUp; ++round) {
    const auto object = static_cast<std::uint64_t>(1 + round / kBatches);
    const int first = kSamples * (round % kBatches);
    v1::ContactBatch batch = batch_of(first, kSamples, object);
    pause();
    const auto sent = Clock::now();
    publisher.publish("probe", batch);
    const v1::Recognition* answer = nullptr;
    do {
      answer = subscriber.receive(std::chrono::seconds(5)).recognition;
      if (answer == nullptr) return false;
    } while (answer->object() != object ||
             answer->sample_count() != static_cast<std::uint64_t>(first + kSamples));
    const double taken = microseconds(Clock::now() - sent);
    const std::int64_t compute_ns = answer->compute_ns();
    const std::uint64_t bytes = answer->ByteSizeLong();
    const std::string payload = batch.SerializeAsString();
    pause();
    const double relay_taken = through_relay(to_relay, from_relay, payload, {bytes, 0});
    pause();
    const double busy_taken = through_relay(to_relay, from_relay, payload, {bytes, compute_ns});
    if (round < kWarmUp) continue;
    const double compute = 1e-3 * static_cast<double>(compute_ns);
    whole.push_back(taken);
    less_compute.push_back(taken - compute);
    relayed.push_back(relay_taken);
    busy_relayed.push_back(busy_taken - compute);
  }
  print(transport, "publish to recognition", whole);
  print(transport, "less its computation", less_compute);
  print(transport, "bare relay", relayed);
  print(transport, "relay as busy (less that)", busy_relayed);
  std::fflush(stdout);
  return true;
}

/// Measures one transport, with a relay of its own.
bool measure_transport(const std::string& transport, const Endpoints& node, const Endpoints& bare,
                       int rounds) {
  const pid_t relay_pid = fork();
  if (relay_pid == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    relay(bare);
  }
  const bool good = measure(transport, node, bare, rounds);
  kill(relay_pid, SIGKILL);
  waitpid(relay_pid, nullptr, 0);
  if (!good) {
    std::fprintf(stderr, "bench_latency: no answer from the node over %s\n", transport.c_str());
  }
  return good;
}

}  // namespace

int main(int argc, char** argv) {
  int rounds = 4000;
  std::string contacts;
  std::string results;
  if (const auto end =
          bench::BenchOptions("Latency of palpate-node beside a bare relay")
              .number("--rounds", rounds, "Batches a transport")
              .text("--contacts", contacts, "Contacts of a node that runs already, with --results")
              .text("--results", results, "Its results: no node is started, one transport measured")
              .parse(argc, argv)) {
    return *end;
  }
  if (contacts.empty() != results.empty()) {
    std::fprintf(stderr, "bench_latency: --contacts and --results name one node together\n");
    return 2;
  }
  const TemporaryFolder folder;
  std::printf("transport,what,p50_us,p90_us,p99_us,max_us\n");
  std::fflush(stdout);
  if (!contacts.empty()) {
    const std::string at = "ipc://" + folder.path();
    return measure_transport("given", {contacts, results}, {at + "/in", at + "/out"}, rounds) ? 0
                                                                                              : 1;
  }
  for (const std::string transport : {"ipc", "tcp"}) {
    const auto at = [&](const char* name, const char* port) {
      return transport == "ipc" ? "ipc://" + folder.path() + "/" + name
                                : std::string("tcp://127.0.0.1:") + port;
    };
    const Endpoints bare{at("relay_in", "15583"), at("relay_out", "15584")};
    const Endpoints ours{at("node_in", "15581"), at("node_out", "15582")};
    const NodeProcess node(ours.in, ours.out);
    if (!measure_transport(transport, ours, bare, rounds)) return 1;
  }
  return 0;
}
