// A planner's side: receives recognitions, local estimates, the recognizer's status and the
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
  const v1::Recognition* latest(std::string_view group) const { return decoder_.latest(group); }

  /// Groups that have been heard of.
  std::vector<std::string> groups() const { return decoder_.groups(); }

  const SubscriberCounters& counters() const { return decoder_.counters(); }

  /// Why the recognizer refuses this client, to be read after its name: "refuses our key: ...".
  /// Empty where it does not. libzmq does not try again: only a new subscriber can.
  const std::string& refusal() { return handshakes_.refusal(); }

  /// ZeroMQ's socket, to be polled beside others: readable where receive() may have news.
  zmq::socket_t& socket() { return socket_; }

 private:
  zmq::context_t context_;
  zmq::socket_t socket_;
  HandshakeWatch handshakes_;
  ResultDecoder decoder_;
};

}  // namespace palpate::client
