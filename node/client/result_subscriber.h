// A planner's side: receives recognitions, local estimates, the recognizer's status and the
// contacts that it accepts.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
#include <zmq.hpp>

#include "node/intake/sequence_tracker.h"
#include "node/wire/endpoint.h"
#include "node/wire/handshake_watch.h"
#include "node/wire/socket.h"
#include "palpate/v1/contact.pb.h"
#include "palpate/v1/local_estimate.pb.h"
#include "palpate/v1/node_status.pb.h"
#include "palpate/v1/recognition.pb.h"

namespace palpate::client {

struct ResultSubscriberOptions {
  /// The recognizer's results endpoint; a bare address is connected to.
  std::string endpoint{kDefaultResultsEndpoint};
  /// Groups whose recognitions to receive; empty = all.
  std::vector<std::string> groups;
  bool estimates = false;  ///< receive LocalEstimate of every probe
  bool status = false;     ///< receive NodeStatus
  bool contacts = false;   ///< receive the ContactBatch that the recognizer accepts, of every probe
  std::optional<CurveClient> curve;
  /// Messages that wait for a planner that does not read before further ones are lost.
  int high_water_mark = 1000;
  /// Topics remembered; messages of further ones are malformed. A recognizer has at most its groups
  /// and twice its probes.
  std::size_t most_topics = 4096;
};

/// What one receive brought: at most one of them, valid until the next call; none = timeout.
struct ReceivedResult {
  const v1::Recognition* recognition = nullptr;
  const v1::LocalEstimate* estimate = nullptr;
  const v1::NodeStatus* status = nullptr;
  const v1::ContactBatch* contact = nullptr;

  explicit operator bool() const {
    return recognition != nullptr || estimate != nullptr || status != nullptr || contact != nullptr;
  }
};

struct SubscriberCounters {
  std::uint64_t received = 0;    ///< messages given out
  std::uint64_t duplicates = 0;  ///< dropped: repeated last values, or from before a restart
  std::uint64_t gaps = 0;        ///< holes in seq
  std::uint64_t missing = 0;     ///< messages in the holes
  std::uint64_t restarts = 0;    ///< of the recognizer, counted on each topic
  std::uint64_t malformed = 0;   ///< not of this contract
};

/// Connects, and reconnects, by itself; on connecting, the latest recognition of every group comes
/// at once. Each message is given out once, in order. Belongs to one thread.
class ResultSubscriber {
 public:
  /// Throws std::invalid_argument on a bad endpoint or group and std::runtime_error where it cannot
  /// be attached.
  explicit ResultSubscriber(const ResultSubscriberOptions& options = {});

  /// The next message; waits for at most `timeout`.
  ReceivedResult receive(std::chrono::milliseconds timeout);

  /// For planners that want the present and not the past: waits for at most `timeout` until a
  /// recognition comes, takes in all that has arrived, and returns true if there is a newer answer
  /// for any group. Read it with latest().
  bool update(std::chrono::milliseconds timeout);

  /// The latest recognition of that group, nullptr where none has come; valid until the next
  /// receive() or update().
  const v1::Recognition* latest(std::string_view group) const;

  /// Groups that have been heard of.
  std::vector<std::string> groups() const;

  const SubscriberCounters& counters() const { return counters_; }

  /// Why the recognizer refuses this client, to be read after its name: "refuses our key: ...".
  /// Empty where it does not. libzmq does not try again: only a new subscriber can.
  const std::string& refusal() { return handshakes_.refusal(); }

  /// ZeroMQ's socket, to be polled beside others: readable where receive() may have news.
  zmq::socket_t& socket() { return socket_; }

 private:
  // One topic each. Recognitions are kept so that latest() can give them.
  struct Feed {
    SequenceTracker sequence;
    v1::Recognition recognition;
  };

  bool has_room_for(std::string_view topic) const;
  bool take(TwoFrames& message, ReceivedResult& result);
  template <typename Message>
  bool is_fresh(const Message& message, std::string_view topic);

  zmq::context_t context_;
  zmq::socket_t socket_;
  HandshakeWatch handshakes_;
  std::size_t most_topics_;
  std::map<std::string, Feed, std::less<>> feeds_;
  v1::Recognition recognition_;
  v1::LocalEstimate estimate_;
  v1::NodeStatus status_;
  v1::ContactBatch contact_;
  SubscriberCounters counters_;
};

}  // namespace palpate::client
