// Decides which CURVE clients may connect (ZeroMQ's authentication protocol, ZAP 1.0), and knows
// them again by their messages.
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

/// The public keys that may connect, and what each may do.
class ClientList {
 public:
  /// What is no key is left out (read_allowed_clients gives none such).
  explicit ClientList(const std::vector<AllowedClient>& clients);

  /// `key` in Z85.
  bool allows(std::string_view key) const { return clients_.find(key) != clients_.end(); }

  /// Who is not on the list may publish as nobody. Valid as long as the list and `key`.
  Sender sender(std::string_view key) const;

  /// Whether all of the other's keys may connect here too.
  bool allows_all_of(const ClientList& other) const;

 private:
  std::map<std::string, std::optional<ProbeNames>, std::less<>> clients_;  // by key, Z85
};

/// Answer to one ZAP request: version, request id, status code, status text, user id, metadata.
/// `frames`: version, request id, domain, address, identity, mechanism, credentials. Everything but
/// an allowed CURVE key of our domain is refused. The user id is that key in Z85: libzmq keeps it
/// with every message of the connection.
std::array<std::string, 6> zap_reply(std::span<const std::string> frames,
                                     const ClientList& clients);

/// Serves libzmq's requests on its well-known address. Make it before the sockets that ask.
class ZapHandler {
 public:
  /// Throws zmq::error_t where the context has a handler already.
  ZapHandler(zmq::context_t& context, ClientList clients);

  /// Answers what has been asked so far.
  void serve();

  /// Who may connect from now on.
  void allow(ClientList clients) { clients_ = std::move(clients); }
  const ClientList& clients() const { return clients_; }

  /// Who sent this frame. By the list as it is now, not as it was when the sender connected.
  Sender sender_of(const zmq::message_t& frame) const;

  /// To be polled for input.
  zmq::socket_t& socket() { return socket_; }

  std::uint64_t denied_count() const { return denied_count_; }
  /// Address of the last client that was denied.
  const std::string& last_denied() const { return last_denied_; }

 private:
  ClientList clients_;
  zmq::socket_t socket_;
  std::uint64_t denied_count_ = 0;
  std::string last_denied_;
};

}  // namespace palpate
