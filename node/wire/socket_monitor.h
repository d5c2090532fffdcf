// What libzmq tells of a socket's connections.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <zmq.hpp>

namespace palpate {

struct SocketEvent {
  std::uint16_t event = 0;  ///< ZMQ_EVENT_...
  std::uint32_t value = 0;  ///< what the event says of its value: a descriptor, an error number
  std::string address;
};

/// One a socket: libzmq tells its events to one listener. Belongs to the socket's thread, and must
/// be destroyed before the socket.
class SocketMonitor {
 public:
  /// `events`: the ZMQ_EVENT_... to hear of, or'ed. Throws zmq::error_t where it cannot be made.
  SocketMonitor(zmq::context_t& context, zmq::socket_t& socket, int events);
  ~SocketMonitor();
  SocketMonitor(const SocketMonitor&) = delete;
  SocketMonitor& operator=(const SocketMonitor&) = delete;

  /// The next event that has come; nullopt where there is none.
  std::optional<SocketEvent> next();

  /// To be polled for input.
  zmq::socket_t& events() { return events_; }

 private:
  zmq::socket_t& socket_;
  zmq::socket_t events_;
};

}  // namespace palpate
