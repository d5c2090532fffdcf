// Decides which CURVE clients may connect (ZeroMQ's authentication protocol, ZAP 1.0) and
// identifies the sender of each message.
#pragma once

#include <array>
#include <cstdint>
#include <map>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>
#include <zmq.hpp>

#include "node/security/sender.h"
#include "node/wire/curve_keys.h"

namespace palpate {

/// The public keys that may connect, and the rights of each.
class ClientList {
 public:
  /// Skips entries whose key is invalid (read_allowed_clients returns none such).
  explicit ClientList(const std::vector<AllowedClient>& clients);

  /// `key` in Z85.
  bool allows(std::string_view key) const { return clients_.find(key) != clients_.end(); }

  /// Rights of that key. A key that is not on the list may publish under no name. Valid as long as
  /// the list and `key`.
  Sender sender(std::string_view key) const;

  /// True if all keys of `other` may connect here too.
  bool allows_all_of(const ClientList& other) const;

 private:
  std::map<std::string, std::optional<ProbeNames>, std::less<>> clients_;  // by key, Z85
};

/// Answers one ZAP request. Returns version, request id, status code, status text, user id and
/// metadata. `frames`: version, request id, domain, address, identity, mechanism, credentials.
/// Accepts only an allowed CURVE key of our domain. The user id is that key in Z85; libzmq attaches
/// it to every message of the connection.
std::array<std::string, 6> zap_reply(std::span<const std::string> frames,
                                     const ClientList& clients);

/// The key by which the sender of this frame was let in, in Z85; empty without CURVE. Valid as long
/// as the frame.
std::string_view key_of(const zmq::message_t& frame);

/// Serves libzmq's requests on its well-known address. Create it before the sockets that use it.
class ZapHandler {
 public:
  /// Throws zmq::error_t if the context already has a handler.
  ZapHandler(zmq::context_t& context, ClientList clients);

  /// Answers all pending requests.
  void serve();

  /// Replaces the list of clients that may connect.
  void allow(ClientList clients) { clients_ = std::move(clients); }
  const ClientList& clients() const { return clients_; }

  /// Sender with this key (key_of), with the rights of the present list, not of the list at the
  /// time of connecting.
  Sender sender_of(std::string_view key) const { return clients_.sender(key); }

  /// To be polled for input.
  zmq::socket_t& socket() { return socket_; }

  std::uint64_t denied_count() const { return denied_count_; }
  /// Address of the client that was denied last.
  const std::string& last_denied() const { return last_denied_; }

 private:
  ClientList clients_;
  zmq::socket_t socket_;
  std::uint64_t denied_count_ = 0;
  std::string last_denied_;
};

}  // namespace palpate
