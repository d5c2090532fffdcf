#include "node/gateway/upward.h"

#include <stdexcept>
#include <utility>

namespace palpate::gateway {
namespace {

using std::chrono::milliseconds;

constexpr milliseconds kDrainTime{2};
// Maximum of topics per cell: as many probes and groups as the largest node accepts (kMostThings in
// node/options.h).
constexpr std::size_t kMostTopics = 200'000;
// A topic that is silent for longer makes room for others: nobody sends it any more.
constexpr std::chrono::seconds kTopicIdle{60};
// The node's queue for us holds some thousands more. Beyond both the oldest messages are lost, as
// their sequence numbers show.
constexpr int kHighWaterMark = 20'000;
// How far this gateway may be behind another gateway of the cell when it starts: the time that
// messages wait in the queues between a node and a running gateway.
constexpr milliseconds kHold{1000};

SocketSettings settings_of(const UpwardOptions& options) {
  SocketSettings settings;
  settings.receive_high_water_mark = kHighWaterMark;
  settings.curve_client = options.curve;
  return settings;
}

}  // namespace

Upward::Upward(zmq::context_t& context, Plant& plant, const UpwardOptions& options)
    : options_(options),
      socket_(make_socket(context, zmq::socket_type::sub, settings_of(options))),
      handshakes_(context, socket_),
      spool_(options.spool_folder, options.spool_bytes),
      outbox_(plant,
              [this](const Outgoing& message, Outbox::End end) {
                if (message.segment != 0) spool_.release(message.segment);
                if (end == Outbox::End::Stored) counters_.set_stored(counters_.stored() + 1);
                if (end == Outbox::End::StoredBefore) {
                  counters_.set_stored_before(counters_.stored_before() + 1);
                }
                if (end == Outbox::End::Refused) counters_.set_refused(counters_.refused() + 1);
              }),
      topics_(kMostTopics, kTopicIdle) {
  outbox_.hold_until(now_steady() + kHold);
  // Three prefixes, however many topics: libzmq loses subscriptions beyond a thousand when it
  // reconnects.
  for (const TopicKind kind : options_.kinds) {
    socket_.set(zmq::sockopt::subscribe, topic_prefix(kind));
  }
  if (const std::string error = attach(socket_, options_.endpoint); !error.empty()) {
    throw std::runtime_error(error);
  }
}

bool Upward::serve(SteadyTime now) {
  TwoFrames message;
  const bool more = drain(socket_, message, kHighWaterMark, now + kDrainTime,
                          [&](const TwoFrames& taken) { take(taken, now); });
  outbox_.tend(now);
  while (outbox_.has_room(now)) {
    std::optional<Spool::Taken> taken = spool_.next();
    if (!taken) break;
    auto to = address(options_.cell, taken->message.topic, taken->message.payload);
    if (!to) {  // not written by us
      counters_.set_malformed(counters_.malformed() + 1);
      spool_.release(taken->segment);
      continue;
    }
    outbox_.add({std::move(*to), std::move(taken->message.payload), taken->segment, 0, {}}, now);
  }
  return more;
}

void Upward::take(const TwoFrames& message, SteadyTime now) {
  const std::string_view topic = view_of(message.topic);
  const std::string_view payload = view_of(message.payload);
  std::optional<Addressed> to;
  if (message.frame_count == 2) to = address(options_.cell, topic, payload);
  SequenceTracker* const sequence = to ? topics_.hear(topic, now) : nullptr;
  if (sequence == nullptr) {
    counters_.set_malformed(counters_.malformed() + 1);
    return;
  }
  const std::uint64_t missing = sequence->missing();
  const SequenceEvent event = sequence->take(to->epoch, to->seq);
  counters_.set_missing(counters_.missing() + sequence->missing() - missing);
  if (!is_news(event)) return;
  counters_.set_received(counters_.received() + 1);
  // What waits on disk goes first.
  if (spool_.empty() && outbox_.has_room(now)) {
    outbox_.add(
        {std::move(*to), std::string(payload), 0, spool_.next_segment(), std::string(topic)}, now);
  } else {
    spool_.add(topic, payload);
  }
}

bool Upward::send_rest(SteadyTime now) {
  outbox_.tend(now);
  return outbox_.size() == 0;
}

void Upward::keep_unsent() {
  // What was read from a segment is still in it: it is deleted when all of it is stored.
  for (const Outgoing& message : outbox_.take_all()) {
    if (message.segment == 0) {
      spool_.add_before(message.before_segment, message.topic, message.payload);
    }
  }
}

void Upward::fill(v1::GatewayUpStatus& status) const {
  status = counters_;
  status.set_waiting(outbox_.size());
  status.set_spooled(spool_.size());
  status.set_spool_bytes(spool_.bytes());
  status.set_lost(spool_.lost());
}

}  // namespace palpate::gateway
