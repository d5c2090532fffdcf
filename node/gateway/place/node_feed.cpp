#include "node/gateway/place/node_feed.h"

#include <chrono>
#include <optional>
#include <utility>

#include "node/wire/parse.h"
#include "node/wire/topics.h"
#include "palpate/v1/contact.pb.h"
#include "palpate/v1/node_status.pb.h"

namespace palpate::gateway {
namespace {

// Maximum of contacts sent to the node and unanswered. The node would reject only beyond 16 MiB
// (one group may use half of max_waiting_bytes).
constexpr std::size_t kMostInFlight = 512;
constexpr std::size_t kMostBytesInFlight = std::size_t{4} << 20;
// A node publishes its status every second.
constexpr std::chrono::milliseconds kNodeSilence{5000};

}  // namespace

NodeFeed::NodeFeed(zmq::context_t& context, FedNodeOptions node, Events events)
    : context_(context), options_(std::move(node)), events_(std::move(events)) {}

void NodeFeed::begin(const std::string& name, SteadyTime now) {
  node_ = std::make_unique<FedNode>(context_, options_, name);
  heard_ = now;
}

void NodeFeed::forget() {
  node_.reset();
  has_spoken_ = false;
  ready_.clear();
  given_.clear();
  given_count_ = in_flight_count_ = in_flight_bytes_ = 0;
  groups_.clear();
}

void NodeFeed::add(const std::string& group, FedContact contact) {
  Entry& entry = *groups_.try_emplace(group).first;
  entry.second.feed.add(std::move(contact));
  make_ready(entry);
}

void NodeFeed::serve(SteadyTime now) {
  TwoFrames message;
  // (Handling a message may forget everything.)
  while (node_ && node_->receive(message)) hear(message);
  if (!node_) return;
  if (const std::string& how = node_->how_ended(); !how.empty()) {
    return events_.failed("its node " + how);
  }
  if (now - heard_ > kNodeSilence) return events_.failed("its node says nothing");
  if (node_->is_ready(has_spoken_)) give();
}

void NodeFeed::make_ready(Entry& group) {
  if (group.second.is_ready) return;
  group.second.is_ready = true;
  ready_.push_back(&group);
}

void NodeFeed::give() {
  while (!ready_.empty()) {
    Group& group = ready_.front()->second;
    while (const FedContact* contact = group.feed.next()) {
      if (in_flight_count_ >= kMostInFlight || in_flight_bytes_ >= kMostBytesInFlight) return;
      node_->send(make_topic(TopicKind::Contact, contact->probe), contact->payload);
      given_.push_back({ready_.front(), *contact});
      given_.back().contact.payload = std::string();
      ++given_count_;
      ++in_flight_count_;
      in_flight_bytes_ += contact->bytes;
      group.feed.given();
    }
    ready_.pop_front();
    group.is_ready = false;
  }
}

void NodeFeed::hear(const TwoFrames& message) {
  const std::optional<Topic> topic = parse_topic(view_of(message.topic));
  if (!topic || message.frame_count != 2) return;
  const std::string_view payload = view_of(message.payload);
  if (topic->kind == TopicKind::Contact) {
    v1::ContactBatch batch;
    if (parse(batch, payload)) took(batch.header(), topic->name);
  } else if (topic->kind == TopicKind::Recognition) {
    v1::Recognition recognition;
    if (parse(recognition, payload)) answered(recognition, payload);
  } else if (topic->kind == TopicKind::Status) {
    v1::NodeStatus node;
    if (!parse(node, payload)) return;
    has_spoken_ = true;
    heard_ = now_steady();
    // The node has judged this many contacts, and has already shown those that it accepted; the
    // rest are rejected.
    while (!given_.empty() && given_count_ - given_.size() < node.messages_received()) {
      rejected();
    }
  }
}

/// The node shows the contacts that it accepts in the order in which they were sent. Those that it
/// skips it has rejected.
void NodeFeed::took(const v1::Header& header, std::string_view probe) {
  while (!given_.empty()) {
    const FedContact& first = given_.front().contact;
    if (first.seq == header.seq() && first.epoch == header.epoch() && first.probe == probe) {
      given_.front().group->second.feed.accepted(first.stream_seq);
      given_.pop_front();
      return;
    }
    rejected();
  }
}

void NodeFeed::rejected() {
  const Given given = std::move(given_.front());
  given_.pop_front();
  auto& [name, group] = *given.group;
  const std::optional<FedContact> out = group.feed.rejected(given.contact.stream_seq);
  if (out) {
    --in_flight_count_;
    in_flight_bytes_ -= out->bytes;
    events_.rejected(name, *out);
  }
  make_ready(*given.group);
}

void NodeFeed::answered(const v1::Recognition& recognition, std::string_view payload) {
  const auto found = groups_.find(recognition.group());
  if (found == groups_.end()) return;
  GroupFeed& feed = found->second.feed;
  const std::size_t count = feed.in_flight_count();
  const std::size_t bytes = feed.in_flight_bytes();
  const std::optional<AnsweredSpan> span =
      feed.answered(recognition.newest_batch_source(), recognition.newest_batch_epoch(),
                    recognition.newest_batch_seq());
  in_flight_count_ -= count - feed.in_flight_count();
  in_flight_bytes_ -= bytes - feed.in_flight_bytes();
  make_ready(*found);
  if (span) events_.answered(recognition, *span, payload);
}

}  // namespace palpate::gateway
