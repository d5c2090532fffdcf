// The client of a planner: receives recognitions, local estimates, the recognizer's status, and the
// contacts that it accepts.
#pragma once

#include <chrono>
#include <cstddef>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
#include <zmq.hpp>

#include "node/client/result_decoder.h"
#include "node/wire/endpoint.h"
#include "node/wire/handshake_watch.h"
#include "node/wire/socket.h"

namespace palpate::client {

struct ResultSubscriberOptions {
  /// The recognizer's results endpoint. An address without "bind:" or "connect:" is connected to.
  std::string endpoint{kDefaultResultsEndpoint};
  /// Groups whose recognitions are received; empty = all.
  std::vector<std::string> groups;
  bool estimates = false;  ///< receive LocalEstimate of every probe
  bool status = false;     ///< receive NodeStatus
  bool contacts = false;   ///< receive the ContactBatches of all probes that the recognizer accepts
  std::optional<CurveClient> curve;
  /// Messages that may wait for a planner that does not read. Further ones are lost.
  int high_water_mark = 1000;
  /// Number of topics remembered, for latest() too: at a time a recognizer has at most as many as
  /// groups plus twice its probes. A further one takes the place of the one that is silent for
  /// longest, if that is so for ten seconds; else its messages are dropped and counted
  /// (over_bound).
  std::size_t most_topics = 4096;
};

/// Connects and reconnects by itself. The latest recognition of every group arrives on connecting.
/// Returns each message once, in order. Not thread-safe.
class ResultSubscriber {
 public:
  /// Throws std::invalid_argument if the endpoint or a group name is malformed and
  /// std::runtime_error if the endpoint cannot be attached.
  explicit ResultSubscriber(const ResultSubscriberOptions& options = {});

  /// Returns the next message; waits for at most `timeout`.
  ReceivedResult receive(std::chrono::milliseconds timeout);

  /// For planners that need only the newest state. Waits at most `timeout` for a recognition, reads
  /// everything that has arrived, and returns true if any group has a newer answer. Get it with
  /// latest().
  bool update(std::chrono::milliseconds timeout);

  /// The latest recognition of the group, or nullptr if none has come. Valid until the next
  /// receive() or update().
  const v1::Recognition* latest(std::string_view group) const { return decoder_.latest(group); }

  /// Groups with at least one message so far.
  std::vector<std::string> groups() const { return decoder_.groups(); }

  const SubscriberCounters& counters() const { return decoder_.counters(); }

  /// Why the recognizer refuses this client, worded to follow its name: "refuses our key: ...".
  /// Empty if it does not refuse. libzmq does not try again; create a new subscriber.
  const std::string& refusal() { return handshakes_.refusal(); }

  /// The ZeroMQ socket, to be polled with others. When it is readable, receive() may return a
  /// message.
  zmq::socket_t& socket() { return socket_; }

 private:
  zmq::context_t context_;
  zmq::socket_t socket_;
  HandshakeWatch handshakes_;
  ResultDecoder decoder_;
};

}  // namespace palpate::client
