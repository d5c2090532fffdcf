// The recognizer's place, taken by a tool that listens to probes in its stead.
#pragma once

#include <chrono>
#include <functional>
#include <optional>
#include <string>
#include <zmq.hpp>

#include "node/security/node_keys.h"
#include "node/tool/commands/command.h"
#include "node/wire/handshake_watch.h"
#include "node/wire/path_lock.h"
#include "node/wire/socket.h"

namespace palpate {

/// What the recognizer would be told.
struct ListeningFlags {
  std::string endpoint;
  std::string curve_secret_key;
  std::string allow_clients;
  bool insecure = false;
};

/// A socket that receives everything, bound as the recognizer's or connected.
class ListeningPlace {
 public:
  ListeningPlace() : context_(1) {}

  /// Binds where the recognizer would, under its conditions: keys, or nothing open to the network
  /// unless that is said aloud. Returns kDone, or has complained.
  int open_as_recognizer(const ListeningFlags& flags);

  /// Connects as a client of the recognizer. Returns kDone, or has complained.
  int open_as_client(const std::string& endpoint, const std::optional<CurveClient>& curve);

  /// Gives every message to take() until that returns false, a stop is asked for, it is `end` or
  /// the recognizer refuses this client; nothing that comes, and however much, delays the end.
  void listen(int stop_fd, std::optional<std::chrono::steady_clock::time_point> end,
              const std::function<bool(const TwoFrames&)>& take);

  /// Who sent this frame; anybody, who may do anything, without CURVE.
  Sender sender_of(const zmq::message_t& frame) const {
    return zap_ ? zap_->sender_of(key_of(frame)) : Sender();
  }

  /// Why the recognizer refuses this client, worded to follow its address; empty if it does not.
  std::string refusal() { return handshakes_ ? handshakes_->refusal() : std::string(); }

  std::uint64_t denied_count() const { return zap_ ? zap_->denied_count() : 0; }

 private:
  int open(const Endpoint& endpoint, const SocketSettings& settings);

  zmq::context_t context_;
  std::optional<ZapHandler> zap_;
  PathLock lock_;
  std::optional<zmq::socket_t> socket_;
  std::optional<HandshakeWatch> handshakes_;  ///< of a client
};

}  // namespace palpate
