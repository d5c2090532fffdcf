// Endpoint options: "bind:tcp://127.0.0.1:5581", "connect:ipc:///run/palpate/contacts".
#pragma once

#include <string>
#include <string_view>

#include "node/files/result.h"

namespace palpate {

inline constexpr std::string_view kDefaultContactsEndpoint = "tcp://127.0.0.1:5581";
inline constexpr std::string_view kDefaultResultsEndpoint = "tcp://127.0.0.1:5582";

struct Endpoint {
  bool bind = false;
  std::string address;  ///< as ZeroMQ takes it: tcp://, ipc:// or inproc://
};

/// A bare address gets `bind_by_default`. Fails on another transport or an empty address.
Result<Endpoint> parse_endpoint(std::string_view text, bool bind_by_default);

/// "bind:ADDRESS" or "connect:ADDRESS".
std::string to_string(const Endpoint& endpoint);

/// True where only this machine can reach the address: ipc, inproc, and tcp on a loopback address.
/// A name other than "localhost" counts as not local: what it means can change.
bool is_local(const Endpoint& endpoint);

}  // namespace palpate
