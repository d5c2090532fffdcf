#include "node/client/result_subscriber.h"

#include <stdexcept>

#include "node/wire/topics.h"

namespace palpate::client {
namespace {

SocketSettings settings_of(const ResultSubscriberOptions& options) {
  SocketSettings settings;
  settings.receive_high_water_mark = options.high_water_mark;
  settings.curve_client = options.curve;
  return settings;
}

}  // namespace

ResultSubscriber::ResultSubscriber(const ResultSubscriberOptions& options)
    : context_(1),
      socket_(make_socket(context_, zmq::socket_type::sub, settings_of(options))),
      handshakes_(context_, socket_),
      decoder_(options.most_topics) {
  const Result<Endpoint> endpoint = parse_endpoint(options.endpoint, /*bind_by_default=*/false);
  if (!endpoint) throw std::invalid_argument(endpoint.error);
  for (const std::string& group : options.groups) {
    if (!is_valid_name(group)) throw std::invalid_argument("\"" + group + "\" is no group's name");
    socket_.set(zmq::sockopt::subscribe, make_topic(TopicKind::Recognition, group));
  }
  if (options.groups.empty()) {
    socket_.set(zmq::sockopt::subscribe, topic_prefix(TopicKind::Recognition));
  }
  if (options.estimates) socket_.set(zmq::sockopt::subscribe, topic_prefix(TopicKind::Estimate));
  if (options.status) socket_.set(zmq::sockopt::subscribe, topic_prefix(TopicKind::Status));
  if (options.contacts) socket_.set(zmq::sockopt::subscribe, topic_prefix(TopicKind::Contact));
  if (const std::string error = attach(socket_, *endpoint.value); !error.empty()) {
    throw std::runtime_error(error);
  }
}

ReceivedResult ResultSubscriber::receive(std::chrono::milliseconds timeout) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  std::vector<zmq::pollitem_t> items{{socket_.handle(), 0, ZMQ_POLLIN, 0}};
  TwoFrames message;
  for (;;) {
    while (receive_now(socket_, message)) {
      if (message.frame_count != 2) {
        decoder_.count_malformed();
        continue;
      }
      const ReceivedResult result = decoder_.take(view_of(message.topic), view_of(message.payload));
      if (result) return result;
    }
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        deadline - std::chrono::steady_clock::now());
    if (left.count() <= 0) return {};
    poll(items, static_cast<int>(left.count()));
  }
}

bool ResultSubscriber::update(std::chrono::milliseconds timeout) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  bool news = false;
  for (;;) {
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        deadline - std::chrono::steady_clock::now());
    const bool wait = !news && left.count() > 0;
    const ReceivedResult result = receive(wait ? left : std::chrono::milliseconds(0));
    if (result.recognition != nullptr) news = true;
    if (!result && (news || left.count() <= 0)) return news;
  }
}

}  // namespace palpate::client
