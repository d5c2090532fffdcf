#include "node/tool/commands/live/topic_counts.h"

#include <chrono>
#include <utility>
#include <vector>

#include "node/wire/endpoint.h"
#include "node/wire/handshake_watch.h"
#include "node/wire/socket.h"

namespace palpate {
namespace {

// Ten times what a recognizer with all its groups and probes publishes on.
constexpr std::size_t kMostTopics = 10'000;

}  // namespace

Result<TopicCounts> count_topics(
    const Connection& connection,
    const std::function<bool(const std::map<std::string, TopicCount>&)>& until) {
  using Counts = Result<TopicCounts>;
  const auto curve = curve_of(connection);
  if (!curve) {
    return Counts::fail(curve.error);
  }
  const Result<Endpoint> endpoint = parse_endpoint(connection.endpoint, /*bind_by_default=*/false);
  if (!endpoint) {
    return Counts::fail(endpoint.error);
  }
  zmq::context_t context(1);
  SocketSettings settings;
  settings.curve_client = *curve.value;
  zmq::socket_t socket = make_socket(context, zmq::socket_type::sub, settings);
  HandshakeWatch handshakes(context, socket);
  socket.set(zmq::sockopt::subscribe, "");
  if (const std::string error = attach(socket, *endpoint.value); !error.empty()) {
    return Counts::fail(error);
  }
  TopicCounts counts;
  std::vector<zmq::pollitem_t> items{{socket.handle(), 0, ZMQ_POLLIN, 0}};
  TwoFrames message;
  while (!until(counts.by_topic)) {
    constexpr int kStepMs = 50;
    poll(items, kStepMs);
    if (const std::string& refusal = handshakes.refusal(); !refusal.empty()) {
      counts.refusal = "the recognizer at " + connection.endpoint + " " + refusal;
      break;
    }
    constexpr int kMostAtOnce = 1000;
    const auto turn = std::chrono::steady_clock::now() + std::chrono::milliseconds(kStepMs);
    drain(socket, message, kMostAtOnce, turn, [&](const TwoFrames&) {
      std::string topic = message.topic.to_string();
      if (counts.by_topic.size() >= kMostTopics && !counts.by_topic.contains(topic))
        topic = "(further topics)";
      counts.by_topic[topic].take({message.payload.data<char>(), message.payload.size()},
                                  std::chrono::steady_clock::now());
    });
  }
  return Counts::ok(std::move(counts));
}

}  // namespace palpate
