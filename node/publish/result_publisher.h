// Publishes results and keeps the latest of each topic for late subscribers.
#pragma once

#include <google/protobuf/message_lite.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <zmq.hpp>

#include "node/security/peer_guard.h"
#include "node/wire/socket.h"
#include "node/wire/topics.h"
#include "palpate/v1/header.pb.h"

namespace palpate {

/// A last-value cache on an XPUB socket. A repeated message reaches all subscribers; it keeps its
/// (epoch, seq), so that they recognise it.
class ResultPublisher {
 public:
  /// `source`: name of the node. The socket must outlive this object and be an XPUB with
  /// ZMQ_XPUB_VERBOSER, which reports every subscription to a prefix (not only the first) and every
  /// end of one.
  ResultPublisher(zmq::socket_t& socket, std::string source);

  /// Sets the header (part of `message`; the frame stays as given), sends the message and keeps it
  /// for late subscribers. An estimate is not kept, because it is part of a stream; a gap in its
  /// seq shows a slow planner what it has lost.
  void publish(TopicKind kind, std::string_view name, v1::Header& header,
               const google::protobuf::MessageLite& message);

  /// Forwards an accepted contact message under its own topic, unchanged. Without a subscriber the
  /// socket drops it uncopied. It is not kept for late subscribers, and its header stays the
  /// probe's.
  void forward(TwoFrames& contact) { forward_now(socket_, contact); }

  /// Reads at most `max_messages` subscriptions and sends the latest message of every topic that
  /// they match. A topic is sent once, however many subscribe, because all subscribers receive it;
  /// and at most once per kLeastRepeat: what comes too soon waits for the next call. `peers` counts
  /// the subscriptions; nullptr = nobody does.
  void serve_subscriptions(int max_messages, PeerGuard* peers,
                           std::chrono::steady_clock::time_point now);

  static constexpr std::chrono::milliseconds kLeastRepeat{50};

  /// True if anybody has subscribed to estimates, of any probe.
  bool estimates_are_wanted() const { return estimate_subscriptions_ > 0; }

  /// Sends the latest message of all topics again. Otherwise a planner that has lost the newest
  /// message to a full queue would keep an old answer until the next touch.
  void repeat_all();

  /// Forgets the topic. If it comes back, it counts from 0 in a new epoch.
  void forget(TopicKind kind, std::string_view name);

  std::uint64_t epoch() const { return epoch_; }

 private:
  struct Feed {
    std::uint64_t epoch = 0;
    std::uint64_t next_seq = 0;
    std::string payload;
    bool is_kept = true;
    bool asked_for = false;
  };

  zmq::socket_t& socket_;
  std::string source_;
  std::uint64_t epoch_;
  bool has_forgotten_ = false;
  std::map<std::string, Feed, std::less<>> feeds_;  // by topic, sorted, so that a prefix is a range
  bool any_asked_for_ = false;
  std::uint64_t estimate_subscriptions_ = 0;
  std::chrono::steady_clock::time_point next_repeat_;
};

}  // namespace palpate
