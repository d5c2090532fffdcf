// Forwards contacts, recognitions and status from a cell to the plant, each once and in order.
#pragma once

#include <cstdint>
#include <string>
#include <vector>
#include <zmq.hpp>

#include "node/gateway/outbox.h"
#include "node/gateway/spool.h"
#include "node/intake/heard_topics.h"
#include "node/intake/sequence_tracker.h"
#include "node/wire/endpoint.h"
#include "node/wire/handshake_watch.h"
#include "node/wire/socket.h"
#include "palpate/v1/gateway_status.pb.h"

namespace palpate::gateway {

struct UpwardOptions {
  std::string cell;
  /// The results endpoint of the cell's node, which forwards the contacts that it accepts. If a
  /// cell has no node: an endpoint to bind, to which its probes connect.
  Endpoint endpoint;
  std::vector<TopicKind> kinds;  ///< the kinds to forward
  std::optional<CurveClient> curve;
  std::string spool_folder;
  std::uint64_t spool_bytes = std::uint64_t{1} << 30;
};

class Upward {
 public:
  /// Throws std::runtime_error if the endpoint or the spool cannot be opened.
  Upward(zmq::context_t& context, Plant& plant, const UpwardOptions& options);

  zmq::socket_t& socket() { return socket_; }

  /// Receives what has come and sends what may go; takes some milliseconds at most. Call it several
  /// times a second. Returns true if more waits.
  bool serve(SteadyTime now);

  /// For the end: receives nothing more, and sends what is in memory. True if all of it is stored.
  bool send_rest(SteadyTime now);

  /// Writes to disk what the plant has not confirmed, for the next process; call it at the end.
  /// What the plant has stored all the same, it knows by its id, for as long as it remembers ids
  /// (duplicate_window_s). If the next process starts later, it is stored twice.
  void keep_unsent();

  /// Why the cell's node refuses this gateway; empty if it does not.
  const std::string& refusal() { return handshakes_.refusal(); }

  void fill(v1::GatewayUpStatus& status) const;
  const std::string& disk_error() const { return spool_.error(); }

 private:
  void take(const TwoFrames& message, SteadyTime now);

  UpwardOptions options_;
  zmq::socket_t socket_;
  HandshakeWatch handshakes_;
  Spool spool_;
  Outbox outbox_;
  HeardTopics<SequenceTracker> topics_;
  v1::GatewayUpStatus counters_;
};

}  // namespace palpate::gateway
