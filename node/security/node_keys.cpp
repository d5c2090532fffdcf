#include "node/security/node_keys.h"

namespace palpate {

Result<NodeKeys> read_node_keys(const std::string& secret_key_path,
                                const std::string& allowed_path) {
  NodeKeys keys;
  if (secret_key_path.empty()) return Result<NodeKeys>::ok(keys);
  if (!curve_available()) return Result<NodeKeys>::fail("libzmq was built without CURVE");
  Result<CurveKeyPair> own = read_curve_keys(secret_key_path);
  if (!own) return Result<NodeKeys>::fail(own.error);
  Result<std::vector<AllowedClient>> clients = read_allowed_clients(allowed_path);
  if (!clients) return Result<NodeKeys>::fail(clients.error);
  keys.own = std::move(*own.value);
  keys.clients = std::move(*clients.value);
  return Result<NodeKeys>::ok(std::move(keys));
}

std::optional<ZapHandler> make_zap_handler(zmq::context_t& context, const NodeKeys& keys) {
  if (!keys.own) return std::nullopt;
  return std::optional<ZapHandler>(std::in_place, context, ClientList(keys.clients));
}

}  // namespace palpate
