// Latency from publishing a batch to receiving the recognition that contains it, less the computation, beside
// a bare two-hop ZeroMQ relay of equal message sizes in the same run; then ingest without loss.
//   bench_latency [--rounds N] [--transport ipc|tcp]
// Turns are taken message by message, so that both see the same machine.
#include <signal.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <string>
#include <thread>
#include <vector>
#include <zmq.hpp>

#include "node/client/contact_publisher.h"
#include "node/client/result_subscriber.h"
#include "node/socket.h"

namespace {

using namespace palpate;
using Clock = std::chrono::steady_clock;

double microseconds(Clock::duration d) {
  return std::chrono::duration<double, std::micro>(d).count();
}

struct Endpoints {
  std::string in;
  std::string out;
};

/// Forwards what comes in as a message of the size that the first eight bytes name.
[[noreturn]] void relay(const Endpoints& endpoints) {
  zmq::context_t context(1);
  zmq::socket_t in = make_socket(context, zmq::socket_type::sub, {});
  zmq::socket_t out = make_socket(context, zmq::socket_type::pub, {});
  in.set(zmq::sockopt::subscribe, "");
  in.bind(endpoints.in);
  out.bind(endpoints.out);
  TwoFrames message;
  std::string payload;
  for (;;) {
    std::vector<zmq::pollitem_t> items{{in.handle(), 0, ZMQ_POLLIN, 0}};
    palpate::poll(items, -1);
    while (receive_now(in, message)) {
      std::uint64_t size = 0;
      std::memcpy(&size, message.payload.data(), sizeof size);
      payload.resize(size);
      send_now(out, message.topic.to_string_view(), payload);
    }
  }
}

pid_t start_relay(const Endpoints& endpoints) {
  const pid_t pid = fork();
  if (pid == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    relay(endpoints);
  }
  return pid;
}

pid_t start_node(const Endpoints& endpoints) {
  const pid_t pid = fork();
  if (pid == 0) {
    prctl(PR_SET_PDEATHSIG, SIGKILL);  // outlives no abort of ours
    execl(PALPATE_NODE, "palpate-node", "--contacts", endpoints.in.c_str(), "--results",
          endpoints.out.c_str(), "--log-level", "off", "--max-samples-per-batch", "1024",
          static_cast<char*>(nullptr));
    std::_Exit(127);
  }
  return pid;
}

v1::ContactBatch batch_of(int first, int count, std::uint64_t object) {
  v1::ContactBatch batch;
  batch.set_object(object);
  for (int i = first; i < first + count; ++i) {
    v1::ContactSample& sample = *batch.add_samples();
    const double wobble = 2.8e-5 * std::sin(12.9898 * i);
    sample.set_x_m((0.02 + wobble) * std::cos(0.01 * i));
    sample.set_y_m((0.02 + wobble) * std::sin(0.01 * i));
    sample.set_sigma_m(2e-5);
    sample.set_stamp_ns(1);
  }
  return batch;
}

void print(const char* name, std::vector<double> values) {
  std::sort(values.begin(), values.end());
  const auto at = [&](double q) {
    return values[std::min(values.size() - 1,
                           static_cast<std::size_t>(q * static_cast<double>(values.size())))];
  };
  std::printf("| %s | %.0f | %.0f | %.0f | %.0f |\n", name, at(0.5), at(0.9), at(0.99), values.back());
}

double quantile(std::vector<double> values, double q) {
  std::sort(values.begin(), values.end());
  return values[static_cast<std::size_t>(q * static_cast<double>(values.size() - 1))];
}

void latency(const Endpoints& node, const Endpoints& bare, int rounds) {
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
  if (!publisher.wait_for_recognizer(std::chrono::seconds(10))) {
    std::fprintf(stderr, "no node\n");
    std::exit(1);
  }
  std::this_thread::sleep_for(std::chrono::milliseconds(300));
  std::vector<double> whole;
  std::vector<double> less_compute;
  std::vector<double> relayed;
  TwoFrames frames;
  constexpr int kBatches = 20;  // of an object
  for (int round = 0; round < rounds; ++round) {
    const auto object = static_cast<std::uint64_t>(1 + round / kBatches);
    v1::ContactBatch batch = batch_of(10 * (round % kBatches), 10, object);
    const auto sent = Clock::now();
    publisher.publish("probe", batch);
    const auto expected = static_cast<std::uint64_t>(10 * (round % kBatches + 1));
    const v1::Recognition* answer = nullptr;
    do {
      answer = subscriber.receive(std::chrono::seconds(5)).recognition;
      if (answer == nullptr) {
        std::fprintf(stderr, "no answer\n");
        std::exit(1);
      }
    } while (answer->object() != object || answer->sample_count() != expected);
    const double taken = microseconds(Clock::now() - sent);
    const double compute = 1e-3 * static_cast<double>(answer->compute_ns());
    // The same through the relay: as many bytes in, as many out.
    std::string payload = batch.SerializeAsString();
    const std::uint64_t size = answer->ByteSizeLong();
    std::memcpy(payload.data(), &size, sizeof size);
    const auto relay_sent = Clock::now();
    std::vector<zmq::pollitem_t> items{{from_relay.handle(), 0, ZMQ_POLLIN, 0}};
    send_now(to_relay, "contact/probe/", payload);
    while (!receive_now(from_relay, frames)) {
      palpate::poll(items, 5000);
    }
    const double relay_taken = microseconds(Clock::now() - relay_sent);
    constexpr int kWarmUp = 100;
    if (round >= kWarmUp) {
      whole.push_back(taken);
      less_compute.push_back(taken - compute);
      relayed.push_back(relay_taken);
    }
    std::this_thread::sleep_for(std::chrono::microseconds(500));
  }
  std::printf("| [us] | p50 | p90 | p99 | max |\n|---|---|---|---|---|\n");
  print("publish to recognition", whole);
  print("less its computation", less_compute);
  print("bare relay", relayed);
  std::printf("\nratio to the relay: median %.2f, p99 %.2f\n\n",
              quantile(less_compute, 0.5) / quantile(relayed, 0.5),
              quantile(less_compute, 0.99) / quantile(relayed, 0.99));
}

/// Publishes batches of 50 at a pace, and reads in NodeStatus what arrived.
void throughput(const Endpoints& node) {
  std::printf("| samples/s offered | batches sent | taken | missing | recognitions |\n|---|---|---|---|---|\n");
  for (const double rate : {50e3, 100e3, 200e3, 400e3, 800e3}) {
    client::ContactPublisherOptions publication;
    publication.endpoint = node.in;
    client::ContactPublisher publisher(publication);
    client::ResultSubscriberOptions subscription;
    subscription.endpoint = node.out;
    subscription.status = true;
    client::ResultSubscriber subscriber(subscription);
    if (!publisher.wait_for_recognizer(std::chrono::seconds(10))) {
      std::exit(1);
    }
    constexpr int kSamples = 50;
    const std::string name = "flood" + std::to_string(static_cast<int>(rate));
    const int batches = static_cast<int>(2.0 * rate / kSamples);  // two seconds
    const auto start = Clock::now();
    std::uint64_t recognitions = 0;
    for (int i = 0; i < batches; ++i) {
      v1::ContactBatch batch =
          batch_of(kSamples * (i % 12), kSamples, static_cast<std::uint64_t>(1 + i / 12));
      std::this_thread::sleep_until(start + std::chrono::duration_cast<Clock::duration>(
                                                std::chrono::duration<double>(i * kSamples / rate)));
      publisher.publish(name, batch);
    }
    std::uint64_t taken = 0;
    std::uint64_t missing = 0;
    const auto end = Clock::now() + std::chrono::seconds(3);
    while (Clock::now() < end) {
      const client::ReceivedResult result = subscriber.receive(std::chrono::milliseconds(100));
      recognitions += result.recognition != nullptr ? 1 : 0;
      if (result.status == nullptr) {
        continue;
      }
      for (const v1::ProbeStatus& probe : result.status->probes()) {
        if (probe.probe() == name) {
          taken = probe.messages();
          missing = probe.missing();
        }
      }
    }
    std::printf("| %.0f | %d | %llu | %llu | %llu |\n", rate, batches,
                static_cast<unsigned long long>(taken), static_cast<unsigned long long>(missing),
                static_cast<unsigned long long>(recognitions));
    std::fflush(stdout);
  }
}

}  // namespace

int main(int argc, char** argv) {
  CLI::App app("Latency and throughput of palpate-node beside a bare relay");
  int rounds = 4000;
  std::string transport = "ipc";
  app.add_option("--rounds", rounds, "Batches for the latency")->capture_default_str();
  app.add_option("--transport", transport)->check(CLI::IsMember({"ipc", "tcp"}))->capture_default_str();
  CLI11_PARSE(app, argc, argv);
  char folder[] = "/tmp/palpate-bench-XXXXXX";
  if (mkdtemp(folder) == nullptr) {
    return 1;
  }
  const std::string path = folder;
  const bool ipc = transport == "ipc";
  const Endpoints node = ipc ? Endpoints{"ipc://" + path + "/a", "ipc://" + path + "/b"}
                             : Endpoints{"tcp://127.0.0.1:15581", "tcp://127.0.0.1:15582"};
  const Endpoints bare = ipc ? Endpoints{"ipc://" + path + "/c", "ipc://" + path + "/d"}
                             : Endpoints{"tcp://127.0.0.1:15583", "tcp://127.0.0.1:15584"};
  const pid_t children[] = {start_relay(bare), start_node(node)};
  std::this_thread::sleep_for(std::chrono::milliseconds(500));  // both have bound
  std::printf("# palpate-node over %s\n\n", transport.c_str());
  latency(node, bare, rounds);
  throughput(node);
  for (const pid_t child : children) {
    kill(child, SIGKILL);
    waitpid(child, nullptr, 0);
  }
  return std::system(("rm -rf " + path).c_str()) == 0 ? 0 : 1;
}
