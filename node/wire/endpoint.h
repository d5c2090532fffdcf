// Endpoint options such as "bind:tcp://127.0.0.1:5581" and "connect:ipc:///run/palpate/contacts".
#pragma once

#include <string>
#include <string_view>

#include "node/files/result.h"

namespace palpate {

inline constexpr std::string_view kDefaultContactsEndpoint = "tcp://127.0.0.1:5581";
inline constexpr std::string_view kDefaultResultsEndpoint = "tcp://127.0.0.1:5582";

struct Endpoint {
  bool bind = false;
  std::string address;  ///< in ZeroMQ's form: tcp:// or ipc://
};

/// An address without prefix gets `bind_by_default`. Fails on any other transport and on an empty
/// address.
Result<Endpoint> parse_endpoint(std::string_view text, bool bind_by_default);

/// "bind:ADDRESS" or "connect:ADDRESS".
std::string to_string(const Endpoint& endpoint);

/// True if only this machine can reach the address: ipc, and tcp on a loopback address. A host name
/// other than "localhost" counts as not local, because its meaning can change.
bool is_local(const Endpoint& endpoint);

}  // namespace palpate
