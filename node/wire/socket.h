// ZeroMQ sockets with this project's settings, and messages of two frames.
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

/// ZAP domain of all the recognizer's sockets.
inline constexpr const char* kZapDomain = "palpate";

struct CurveClient {
  CurveKeyPair keys;
  std::string server_public_key;  ///< Z85
};

struct SocketSettings {
  int send_high_water_mark = 1000;     ///< messages waiting for one peer
  int receive_high_water_mark = 1000;  ///< messages waiting from one peer
  /// Longest frame accepted; a longer one ends the sender's connection. 40 times the longest
  /// message of the recognizer, a Recognition with 1,000 contacts. [bytes]
  std::int64_t max_message_bytes = std::int64_t{16} << 20;
  std::optional<CurveKeyPair> curve_server;  ///< for the recognizer; needs a ZapHandler
  std::optional<CurveClient> curve_client;   ///< for its clients
};

/// Creates a socket with these settings, not yet bound or connected. It notices when a peer dies,
/// reconnects quickly, and waits at most kLingerMs on closing.
zmq::socket_t make_socket(zmq::context_t& context, zmq::socket_type type,
                          const SocketSettings& settings);

/// Binds or connects. Returns an empty string or an error. Binding an ipc path locks it: `lock`
/// receives the lock and must live as long as the socket; without `lock` it is held until the
/// process ends.
std::string attach(zmq::socket_t& socket, const Endpoint& endpoint, PathLock* lock = nullptr);

/// The frame's bytes; valid as long as the frame.
inline std::string_view view_of(const zmq::message_t& frame) {
  return {frame.data<char>(), frame.size()};
}

/// A received message. Of further frames only the number is kept.
struct TwoFrames {
  zmq::message_t topic;
  zmq::message_t payload;
  std::size_t frame_count = 0;
};

/// Receives a waiting message; returns false if there is none. Never blocks. A signal does not make
/// it throw.
bool receive_now(zmq::socket_t& socket, TwoFrames& message);

/// Passes waiting messages to take(message), at most `most` and until `deadline`, so that a flood
/// of messages cannot hold the caller. Returns true if more may wait.
template <typename Take>
bool drain(zmq::socket_t& socket, TwoFrames& message, int most,
           std::chrono::steady_clock::time_point deadline, Take&& take) {
  for (int count = 0; count < most && std::chrono::steady_clock::now() < deadline; ++count) {
    if (!receive_now(socket, message)) return false;
    take(message);
  }
  return true;
}

/// Sends without blocking. Returns false if the socket does not take the message now. A publishing
/// socket takes all: it drops what nobody subscribes to, and what a full queue has no room for.
/// Only with ZMQ_XPUB_NODROP is a message false that a full queue has no room for; nobody gets it
/// then.
bool send_now(zmq::socket_t& socket, std::string_view topic, std::string_view payload);

/// Forwards a received message unchanged and without copying; its frames are empty afterwards.
/// Never blocks. Returns false if the socket does not take it now; see send_now().
bool forward_now(zmq::socket_t& socket, TwoFrames& message);

/// Polls for at most `timeout_ms`. A signal ends it early, like a timeout.
void poll(std::vector<zmq::pollitem_t>& items, int timeout_ms);

}  // namespace palpate
