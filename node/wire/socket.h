// ZeroMQ sockets with this project's settings, and the two-frame message.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string>
#include <string_view>
#include <vector>
#include <zmq.hpp>

#include "node/wire/curve_keys.h"
#include "node/wire/endpoint.h"
#include "node/wire/path_lock.h"

namespace palpate {

/// ZAP domain of the recognizer's sockets; a fixed name, as there is one domain.
inline constexpr const char* kZapDomain = "palpate";

struct CurveClient {
  CurveKeyPair keys;
  std::string server_public_key;  ///< Z85
};

struct SocketSettings {
  int send_high_water_mark = 1000;     ///< messages waiting for one peer
  int receive_high_water_mark = 1000;  ///< messages waiting from one peer
  /// Longest frame accepted; a longer one costs its sender the connection. The longest that the
  /// recognizer sends, a Recognition with 1,000 contacts, is a fortieth of this. [bytes]
  std::int64_t max_message_bytes = std::int64_t{16} << 20;
  std::optional<CurveKeyPair> curve_server;  ///< set on the recognizer's side: needs a ZapHandler
  std::optional<CurveClient> curve_client;   ///< set on the other side
};

/// A socket that notices a peer's end, reconnects quickly and does not linger at exit, with those
/// settings; not yet bound or connected.
zmq::socket_t make_socket(zmq::context_t& context, zmq::socket_type type,
                          const SocketSettings& settings);

/// Binds or connects. Returns an empty string, or what went wrong. Who binds an ipc path locks it:
/// in `lock`, to be kept as long as the socket, or without it until the process ends.
std::string attach(zmq::socket_t& socket, const Endpoint& endpoint, PathLock* lock = nullptr);

/// A frame's bytes, for as long as it lives.
inline std::string_view view_of(const zmq::message_t& frame) {
  return {frame.data<char>(), frame.size()};
}

/// What one receive brought. Frames beyond the second are dropped and counted only.
struct TwoFrames {
  zmq::message_t topic;
  zmq::message_t payload;
  std::size_t frame_count = 0;
};

/// Takes one waiting message; false where none waits. Never blocks, never throws on a signal.
bool receive_now(zmq::socket_t& socket, TwoFrames& message);

/// Takes what waits and gives it to take(message), at most `most` messages and until `deadline`: a
/// flood ends no loop. True where more may wait.
template <typename Take>
bool drain(zmq::socket_t& socket, TwoFrames& message, int most,
           std::chrono::steady_clock::time_point deadline, Take&& take) {
  for (int count = 0; count < most && std::chrono::steady_clock::now() < deadline; ++count) {
    if (!receive_now(socket, message)) return false;
    take(message);
  }
  return true;
}

/// Sends without blocking; false where the peer's high-water mark (or no peer) drops it.
bool send_now(zmq::socket_t& socket, std::string_view topic, std::string_view payload);

/// Sends a message that has come on as it is, without copying it; its frames are empty afterwards.
/// Never blocks; false where the peer's high-water mark drops it.
bool forward_now(zmq::socket_t& socket, TwoFrames& message);

/// Polls for at most `timeout_ms`; a signal ends it early like a timeout.
void poll(std::vector<zmq::pollitem_t>& items, int timeout_ms);

}  // namespace palpate
