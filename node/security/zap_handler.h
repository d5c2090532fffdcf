// Decides which CURVE clients may connect (ZeroMQ's authentication protocol, ZAP 1.0).
#pragma once

#include <array>
#include <cstdint>
#include <set>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>
#include <zmq.hpp>

namespace palpate {

/// The public keys that may connect.
class ClientList {
 public:
  /// Keys in Z85; what is no key is left out (read_public_keys gives none such).
  explicit ClientList(const std::vector<std::string>& public_keys);

  /// `key`: 32 raw bytes, as ZAP gives them.
  bool allows(std::string_view key) const;

  /// Whether all of the other's keys may connect here too.
  bool allows_all_of(const ClientList& other) const;

 private:
  std::set<std::string, std::less<>> keys_;  // raw bytes
};

/// Answer to one ZAP request: version, request id, status code, status text, user id, metadata.
/// `frames`: version, request id, domain, address, identity, mechanism, credentials. Everything but
/// an allowed CURVE key of our domain is refused.
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
