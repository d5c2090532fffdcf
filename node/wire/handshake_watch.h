// Finds out why the other side refuses a connection.
#pragma once

#include <cstdint>
#include <string>
#include <zmq.hpp>

#include "node/wire/socket_monitor.h"

namespace palpate {

/// libzmq reports a refused connection only once and does not try again; without this class a
/// refusal looks as if no one were listening. A listener that disagrees on CURVE may also close the
/// connection again and again without a reason; that counts as a refusal too. Owned by the socket's
/// thread; must be destroyed before the socket.
class HandshakeWatch {
 public:
  /// Create it before the socket connects. Throws zmq::error_t if the monitor cannot be created.
  HandshakeWatch(zmq::context_t& context, zmq::socket_t& socket);

  /// Reads the events and returns the latest refusal, worded to follow the address; empty if there
  /// was none.
  const std::string& refusal();

  /// Whether the other side was there and has gone, as far as is known by now. Of a socket that
  /// connects to one.
  bool is_gone() {
    refusal();
    return is_gone_;
  }

  /// How often it has gone, as far as is known by now.
  std::uint64_t departures() {
    refusal();
    return departures_;
  }

  /// To be polled for input; then call refusal().
  zmq::socket_t& events() { return monitor_.events(); }

 private:
  SocketMonitor monitor_;
  std::string refusal_;
  bool was_there_ = false;
  bool is_gone_ = false;
  std::uint64_t departures_ = 0;
  int closed_in_a_row_ = 0;  ///< connections closed before the handshake succeeded
};

}  // namespace palpate
