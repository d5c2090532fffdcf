// The node's CURVE keys: its own, and those of the clients that may connect.
#pragma once

#include <optional>
#include <string>
#include <vector>
#include <zmq.hpp>

#include "node/files/result.h"
#include "node/security/zap_handler.h"
#include "node/wire/curve_keys.h"

namespace palpate {

struct NodeKeys {
  std::optional<CurveKeyPair> own;  ///< nullopt = no CURVE
  std::vector<AllowedClient> clients;
};

/// Reads the key files. An empty path means no CURVE.
Result<NodeKeys> read_node_keys(const std::string& secret_key_path,
                                const std::string& allowed_path);

/// nullopt without CURVE. Create it before the sockets that use it.
std::optional<ZapHandler> make_zap_handler(zmq::context_t& context, const NodeKeys& keys);

}  // namespace palpate
