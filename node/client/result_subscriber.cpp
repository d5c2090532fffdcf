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

std::string_view view_of(const zmq::message_t& frame) { return {frame.data<char>(), frame.size()}; }

template <typename Message>
bool parse(Message& message, const zmq::message_t& payload) {
  return message.ParseFromArray(payload.data(), static_cast<int>(payload.size()));
}

}  // namespace

ResultSubscriber::ResultSubscriber(const ResultSubscriberOptions& options)
    : context_(1),
      socket_(make_socket(context_, zmq::socket_type::sub, settings_of(options))),
      handshakes_(context_, socket_),
      most_topics_(options.most_topics) {
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

bool ResultSubscriber::has_room_for(std::string_view topic) const {
  return feeds_.size() < most_topics_ || feeds_.contains(topic);
}

template <typename Message>
bool ResultSubscriber::is_fresh(const Message& message, std::string_view topic) {
  const auto found = feeds_.find(topic);
  Feed& feed = found != feeds_.end() ? found->second : feeds_[std::string(topic)];
  const SequenceTracker before = feed.sequence;
  const SequenceEvent event = feed.sequence.take(message.header().epoch(), message.header().seq());
  counters_.gaps += feed.sequence.gaps() - before.gaps();
  counters_.missing += feed.sequence.missing() - before.missing();
  counters_.restarts += feed.sequence.restarts() - before.restarts();
  if (is_news(event)) {
    ++counters_.received;
    return true;
  }
  ++counters_.duplicates;
  return false;
}

bool ResultSubscriber::take(TwoFrames& message, ReceivedResult& result) {
  const std::string_view text = view_of(message.topic);
  const std::optional<Topic> topic =
      message.frame_count == 2 && has_room_for(text) ? parse_topic(text) : std::optional<Topic>();
  if (topic && topic->kind == TopicKind::Recognition && parse(recognition_, message.payload)) {
    if (!is_fresh(recognition_, text)) return false;
    Feed& feed = feeds_.find(text)->second;
    feed.recognition.Swap(&recognition_);
    result.recognition = &feed.recognition;
    return true;
  }
  if (topic && topic->kind == TopicKind::Estimate && parse(estimate_, message.payload)) {
    if (!is_fresh(estimate_, text)) return false;
    result.estimate = &estimate_;
    return true;
  }
  if (topic && topic->kind == TopicKind::Status && parse(status_, message.payload)) {
    if (!is_fresh(status_, text)) return false;
    result.status = &status_;
    return true;
  }
  if (topic && topic->kind == TopicKind::Contact && parse(contact_, message.payload)) {
    if (!is_fresh(contact_, text)) return false;
    result.contact = &contact_;
    return true;
  }
  ++counters_.malformed;
  return false;
}

ReceivedResult ResultSubscriber::receive(std::chrono::milliseconds timeout) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  std::vector<zmq::pollitem_t> items{{socket_.handle(), 0, ZMQ_POLLIN, 0}};
  TwoFrames message;
  ReceivedResult result;
  for (;;) {
    while (receive_now(socket_, message)) {
      if (take(message, result)) return result;
    }
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        deadline - std::chrono::steady_clock::now());
    if (left.count() <= 0) return result;
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

const v1::Recognition* ResultSubscriber::latest(std::string_view group) const {
  if (!is_valid_name(group)) return nullptr;
  const auto found = feeds_.find(make_topic(TopicKind::Recognition, group));
  return found == feeds_.end() ? nullptr : &found->second.recognition;
}

std::vector<std::string> ResultSubscriber::groups() const {
  std::vector<std::string> names;
  for (const auto& [topic, feed] : feeds_) {
    const std::optional<Topic> parsed = parse_topic(topic);
    if (parsed && parsed->kind == TopicKind::Recognition) names.emplace_back(parsed->name);
  }
  return names;
}

}  // namespace palpate::client
