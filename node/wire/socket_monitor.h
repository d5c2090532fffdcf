// The events of a socket's connections, as libzmq reports them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <zmq.hpp>

namespace palpate {

struct SocketEvent {
  std::uint16_t event = 0;  ///< ZMQ_EVENT_...
  std::uint32_t value = 0;  ///< depends on the event: a descriptor or an error number
  std::string address;
};

/// At most one per socket, because libzmq reports events to one listener only. Owned by the
/// socket's thread; must be destroyed before the socket.
class SocketMonitor {
 public:
  /// `events`: the ZMQ_EVENT_... to report, or'ed. Throws zmq::error_t if the monitor cannot be
  /// created.
  SocketMonitor(zmq::context_t& context, zmq::socket_t& socket, int events);
  ~SocketMonitor();
  SocketMonitor(const SocketMonitor&) = delete;
  SocketMonitor& operator=(const SocketMonitor&) = delete;

  /// The next event; nullopt if there is none.
  std::optional<SocketEvent> next();

  /// To be polled for input.
  zmq::socket_t& events() { return events_; }

 private:
  zmq::socket_t& socket_;
  zmq::socket_t events_;
};

}  // namespace palpate
