#include "node/publish/result_publisher.h"

#include "node/process/clock.h"
#include "node/wire/socket.h"

namespace palpate {

ResultPublisher::ResultPublisher(zmq::socket_t& socket, std::string source)
    : socket_(socket), source_(std::move(source)), epoch_(random_epoch()) {}

void ResultPublisher::publish(TopicKind kind, std::string_view name, v1::Header& header,
                              const google::protobuf::MessageLite& message) {
  const std::string topic = make_topic(kind, name);
  auto found = feeds_.find(topic);
  if (found == feeds_.end()) {
    found = feeds_.emplace(topic, Feed()).first;
    // A topic that may have been used before must not count from 0 again in the same epoch:
    // receivers would take its messages for old ones.
    found->second.epoch = has_forgotten_ ? random_epoch() : epoch_;
  }
  Feed& feed = found->second;
  feed.is_kept = kind != TopicKind::Estimate;
  header.set_source(source_);
  header.set_epoch(feed.epoch);
  header.set_seq(feed.next_seq++);
  header.set_stamp_ns(unix_time_ns());
  message.SerializeToString(&feed.payload);
  send_now(socket_, topic, feed.payload);
}

namespace {

/// True if a subscription to `prefix` matches some topic that begins with `topics`.
bool meets(std::string_view prefix, std::string_view topics) {
  return prefix.starts_with(topics) || topics.starts_with(prefix);
}

}  // namespace

void ResultPublisher::serve_subscriptions(int max_messages, PeerGuard* peers,
                                          std::chrono::steady_clock::time_point now) {
  TwoFrames message;
  for (int count = 0; count < max_messages && receive_now(socket_, message); ++count) {
    const std::string_view text(message.topic.data<char>(), message.topic.size());
    // First byte 1: a subscription to the prefix that follows; 0: its end. Other messages are
    // ignored.
    const bool begins = !text.empty() && text.front() == '\1';
    const bool ends = !text.empty() && text.front() == '\0';
    if (message.frame_count != 1 || (!begins && !ends)) continue;
    const std::string_view prefix = text.substr(1);
    if (peers != nullptr) {
      peers->count_subscription(descriptor_of(message.topic), key_of(message.topic), begins,
                                prefix.size());
    }
    if (meets(prefix, topic_prefix(TopicKind::Estimate))) {
      // (A client that subscribes twice ends its subscription once; estimates then continue without
      // a receiver.)
      if (begins) {
        ++estimate_subscriptions_;
      } else if (estimate_subscriptions_ > 0) {
        --estimate_subscriptions_;
      }
    }
    if (ends) continue;
    for (auto feed = feeds_.lower_bound(prefix);
         feed != feeds_.end() && feed->first.starts_with(prefix); ++feed) {
      feed->second.asked_for = feed->second.is_kept;
      any_asked_for_ = any_asked_for_ || feed->second.is_kept;
    }
  }
  if (!any_asked_for_ || now < next_repeat_) return;
  any_asked_for_ = false;
  next_repeat_ = now + kLeastRepeat;
  for (auto& [topic, feed] : feeds_) {
    if (feed.asked_for) send_now(socket_, topic, feed.payload);
    feed.asked_for = false;
  }
}

void ResultPublisher::repeat_all() {
  for (const auto& [topic, feed] : feeds_) {
    if (feed.is_kept) send_now(socket_, topic, feed.payload);
  }
}

void ResultPublisher::forget(TopicKind kind, std::string_view name) {
  if (feeds_.erase(make_topic(kind, name)) > 0) has_forgotten_ = true;
}

}  // namespace palpate
