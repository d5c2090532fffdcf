// Brings a connecting socket back after a peer's oversize frame.
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>
#include <zmq.hpp>

#include "node/wire/socket_monitor.h"

namespace palpate {

/// libzmq (4.3.4) gives a connection up for good when a frame exceeds ZMQ_MAXMSGSIZE: it reports
/// DISCONNECTED and never CONNECT_RETRIED. One bad message would so silence a probe for ever. This
/// watches the socket's events and connects again. Belongs to the socket's thread, and must be
/// destroyed before the socket.
class ReconnectGuard {
 public:
  /// Watches a socket that has been connected to `addresses`. Throws zmq::error_t where the monitor
  /// cannot be made.
  ReconnectGuard(zmq::context_t& context, zmq::socket_t& socket,
                 std::vector<std::string> addresses);

  /// Call often; cheap. Returns true where it has connected again.
  bool tend(std::chrono::steady_clock::time_point now);

 private:
  bool reconnect(const std::string& told);

  zmq::socket_t& socket_;
  std::vector<std::string> addresses_;
  SocketMonitor monitor_;
  std::map<std::string, std::chrono::steady_clock::time_point> silent_since_;  // by address
};

}  // namespace palpate
