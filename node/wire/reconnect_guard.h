// Reconnects a socket after a peer has sent an oversize frame.
#pragma once

#include <chrono>
#include <map>
#include <string>
#include <vector>
#include <zmq.hpp>

#include "node/wire/socket_monitor.h"

namespace palpate {

/// After a frame beyond ZMQ_MAXMSGSIZE, libzmq (4.3.4) gives the connection up for good: it reports
/// DISCONNECTED and never CONNECT_RETRIED. One bad message would silence a probe for ever. This
/// class watches the socket's events and connects again. Owned by the socket's thread; must be
/// destroyed before the socket.
class ReconnectGuard {
 public:
  /// Watches a socket that is connected to `addresses`. Throws zmq::error_t if the monitor cannot
  /// be created.
  ReconnectGuard(zmq::context_t& context, zmq::socket_t& socket,
                 std::vector<std::string> addresses);

  /// Cheap; call it often. Returns true if it has reconnected.
  bool tend(std::chrono::steady_clock::time_point now);

 private:
  bool reconnect(const std::string& told);

  zmq::socket_t& socket_;
  std::vector<std::string> addresses_;
  SocketMonitor monitor_;
  std::map<std::string, std::chrono::steady_clock::time_point> silent_since_;  // by address
};

}  // namespace palpate
