// Publishes results and keeps the latest of each topic for those who come late.
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

/// Last-value cache over an XPUB socket. A repeated message keeps its (epoch, seq), by which
/// receivers know it: a repetition reaches everyone.
class ResultPublisher {
 public:
  /// `source`: name of the node. The socket must outlive this and be an XPUB with
  /// ZMQ_XPUB_VERBOSER, so that every subscription is seen and not only a prefix's first, and the
  /// end of each.
  ResultPublisher(zmq::socket_t& socket, std::string source);

  /// Fills in the header (a part of `message`; the frame stays as given), sends and remembers. An
  /// estimate is one of a stream and not the state of something: sent once, it is not kept for
  /// those who come late, and a hole in its seq says what a slow planner has lost.
  void publish(TopicKind kind, std::string_view name, v1::Header& header,
               const google::protobuf::MessageLite& message);

  /// Sends an accepted contact message on under its own topic, the bytes as they came, to those who
  /// subscribe to it: without a subscriber the socket drops it uncopied. It is not kept for those
  /// who come late, and its header stays the probe's.
  void forward(TwoFrames& contact) { forward_now(socket_, contact); }

  /// Takes the subscriptions that have come, at most `max_messages`, and sends the subscribers the
  /// latest of every topic that they ask for: each once however many ask, and as it reaches all of
  /// them, no oftener than every kLeastRepeat. What comes too soon waits for the next call. `peers`
  /// counts them; nullptr = nobody does.
  void serve_subscriptions(int max_messages, PeerGuard* peers,
                           std::chrono::steady_clock::time_point now);

  static constexpr std::chrono::milliseconds kLeastRepeat{50};

  /// Whether anybody has subscribed to estimates, of any probe.
  bool estimates_are_wanted() const { return estimate_subscriptions_ > 0; }

  /// Sends the latest of all topics again: a planner that has lost the newest message to a full
  /// queue would otherwise stay with an old answer until the next touch.
  void repeat_all();

  /// The topic's name is gone; should it come back, it counts anew under a new epoch.
  void forget(TopicKind kind, std::string_view name);

  std::uint64_t published_count() const { return published_count_; }
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
  std::map<std::string, Feed, std::less<>> feeds_;  // by topic: a prefix is a range
  bool any_asked_for_ = false;
  std::uint64_t estimate_subscriptions_ = 0;
  std::chrono::steady_clock::time_point next_repeat_;
  std::uint64_t published_count_ = 0;
};

}  // namespace palpate
