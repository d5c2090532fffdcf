// Why the other side refuses a connection.
#pragma once

#include <string>
#include <zmq.hpp>

#include "node/wire/socket_monitor.h"

namespace palpate {

/// Who connects and is refused hears it once, and libzmq does not try again: without this it looks
/// as if nobody were there. A listener that disagrees on CURVE may close the connection before it
/// has said so, time after time: that counts as well. Belongs to the socket's thread, and must be
/// destroyed before the socket.
class HandshakeWatch {
 public:
  /// Make it before the socket connects. Throws zmq::error_t where the monitor cannot be made.
  HandshakeWatch(zmq::context_t& context, zmq::socket_t& socket);

  /// Takes the events that have come. What the latest refusal was, for a person to read after the
  /// address; empty where there was none.
  const std::string& refusal();

  /// To be polled for input: refusal() then.
  zmq::socket_t& events() { return monitor_.events(); }

 private:
  SocketMonitor monitor_;
  std::string refusal_;
  int closed_in_a_row_ = 0;  ///< connections, before they were agreed on
};

}  // namespace palpate
