#include "node/client/contact_publisher.h"

#include <stdexcept>
#include <thread>
#include <utility>
#include <vector>

#include "node/process/clock.h"
#include "node/wire/topics.h"

namespace palpate::client {
namespace {

SocketSettings settings_of(const ContactPublisherOptions& options) {
  SocketSettings settings;
  settings.send_high_water_mark = options.high_water_mark;
  settings.curve_client = options.curve;
  return settings;
}

}  // namespace

ContactPublisher::ContactPublisher(const ContactPublisherOptions& options)
    : context_(1),
      // XPUB passes the recognizer's subscription to us as a message: that shows that it listens.
      socket_(make_socket(context_, zmq::socket_type::xpub, settings_of(options))),
      handshakes_(context_, socket_),
      epoch_(random_epoch()) {
  const Result<Endpoint> endpoint = parse_endpoint(options.endpoint, /*bind_by_default=*/false);
  if (!endpoint) throw std::invalid_argument(endpoint.error);
  binds_ = endpoint.value->bind;
  // Without it libzmq drops at the high-water mark and reports success.
  if (!endpoint.value->bind || options.all_readers_or_none) {
    socket_.set(zmq::sockopt::xpub_nodrop, true);
  }
  if (const std::string error = attach(socket_, *endpoint.value); !error.empty()) {
    throw std::runtime_error(error);
  }
}

void ContactPublisher::take_subscriptions() {
  TwoFrames message;
  while (receive_now(socket_, message)) {
    if (message.topic.size() == 0) continue;
    // First byte 1: a prefix has its first subscriber; 0: it has lost its last one.
    const char kind = *message.topic.data<char>();
    if (kind == 1) ++listeners_;
    had_listeners_ = had_listeners_ || listeners_ > 0;
    if (kind == 0 && listeners_ > 0 && --listeners_ == 0) ++departures_;
  }
}

bool ContactPublisher::wait_for_recognizer(std::chrono::milliseconds timeout) {
  const auto deadline = std::chrono::steady_clock::now() + timeout;
  std::vector<zmq::pollitem_t> items{{socket_.handle(), 0, ZMQ_POLLIN, 0},
                                     {handshakes_.events().handle(), 0, ZMQ_POLLIN, 0}};
  for (;;) {
    take_subscriptions();
    if (listeners_ > 0) return true;
    if (!refusal().empty()) return false;
    const auto left = std::chrono::duration_cast<std::chrono::milliseconds>(
        deadline - std::chrono::steady_clock::now());
    if (left.count() <= 0) return false;
    poll(items, static_cast<int>(left.count()));
  }
}

bool ContactPublisher::publish(std::string_view probe, v1::ContactBatch& batch) {
  return publish_when_room(probe, batch, std::chrono::seconds(0), [] { return false; });
}

bool ContactPublisher::publish_when_room(std::string_view probe, v1::ContactBatch& batch,
                                         std::chrono::duration<double> longest,
                                         const std::function<bool()>& is_stopped) {
  const SteadyTime start = now_steady();
  Probe* const state = state_of(probe);
  if (state == nullptr) return false;
  take_subscriptions();
  v1::Header& header = *batch.mutable_header();
  header.set_source(std::string(probe));
  header.set_epoch(epoch_);
  header.set_seq(state->next_seq++);
  for (;;) {
    // Anew for each attempt: the time of waiting for room is not on the way.
    header.set_stamp_ns(unix_time_ns());
    batch.SerializeToString(&buffer_);
    if (send_now(socket_, state->topic, buffer_)) {
      published_to_nobody_ += binds_ && listeners_ == 0 ? 1 : 0;
      return true;
    }
    if (is_stopped() || now_steady() - start >= longest) return false;
    // An XPUB is always writable to a poll, so there is nothing to wait for but time.
    constexpr std::chrono::milliseconds kAgain{1};
    std::this_thread::sleep_for(kAgain);
  }
}

void ContactPublisher::leave_out(std::string_view probe, std::uint64_t messages) {
  if (Probe* const state = state_of(probe)) state->next_seq += messages;
}

ContactPublisher::Probe* ContactPublisher::state_of(std::string_view probe) {
  auto found = probes_.find(probe);
  if (found == probes_.end()) {
    if (!is_valid_name(probe)) return nullptr;
    found = probes_.emplace(probe, Probe{make_topic(TopicKind::Contact, probe)}).first;
  }
  return &found->second;
}

bool ContactPublisher::recognizer_has_gone() {
  take_subscriptions();
  // A socket that connects keeps the subscriptions of the other side for its return.
  return binds_ ? had_listeners_ && listeners_ == 0 : handshakes_.is_gone();
}

std::string ContactPublisher::news_of_recognizer() {
  const bool is_gone = recognizer_has_gone();
  const std::uint64_t departures = binds_ ? departures_ : handshakes_.departures();
  const bool has_left = std::exchange(departures_told_, departures) != departures;
  const bool was_gone = std::exchange(is_gone_told_, is_gone);
  if (is_gone && has_left) {
    return binds_ ? "has gone: nobody listens, and what is published meanwhile is lost"
                  : "has gone: what was on its way to it may be lost, what is published now waits";
  }
  if (is_gone || (!was_gone && !has_left)) return {};
  return std::string(was_gone ? "is back" : "has gone and is back")
      .append(": if it was started anew, it has forgotten what came before");
}

void ContactPublisher::finish_within(std::chrono::milliseconds longest) {
  socket_.set(zmq::sockopt::linger, static_cast<int>(longest.count()));
}

}  // namespace palpate::client
