// Brings a connecting socket back after a peer's oversize frame.
#pragma once

#include <chrono>
#include <optional>
#include <string>
#include <zmq.hpp>

namespace palpate {

/// libzmq (4.3.4) gives a connection up for good when a frame exceeds ZMQ_MAXMSGSIZE: it reports
/// DISCONNECTED and never CONNECT_RETRIED. One bad message would so silence a probe for ever. This
/// watches the socket's events and connects again. Belongs to the socket's thread.
class ReconnectGuard {
 public:
  /// Watches a socket that has been connected to `address`. Throws zmq::error_t where the monitor
  /// cannot be made.
  ReconnectGuard(zmq::context_t& context, zmq::socket_t& socket, std::string address);
  ~ReconnectGuard();
  ReconnectGuard(const ReconnectGuard&) = delete;
  ReconnectGuard& operator=(const ReconnectGuard&) = delete;

  /// Call often; cheap. Returns true where it has connected again.
  bool tend(std::chrono::steady_clock::time_point now);

 private:
  zmq::socket_t& socket_;
  std::string address_;
  zmq::socket_t events_;
  std::optional<std::chrono::steady_clock::time_point> given_up_since_;
};

}  // namespace palpate
