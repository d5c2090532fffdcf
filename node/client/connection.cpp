#include "node/client/connection.h"

namespace palpate::client {

Result<CurveClient> read_curve_client(const std::string& own_secret_path,
                                      const std::string& recognizer_public_path) {
  using Client = Result<CurveClient>;
  if (own_secret_path.empty() || recognizer_public_path.empty()) {
    return Client::fail(
        std::string("CURVE needs two key files: ") +
        (own_secret_path.empty() ? "our own secret key file" : "the recognizer's public key file") +
        " is not named");
  }
  Result<CurveKeyPair> own = read_curve_keys(own_secret_path);
  if (!own) return Client::fail(own.error);
  Result<std::vector<std::string>> server = read_public_keys(recognizer_public_path);
  if (!server) return Client::fail(server.error);
  if (server.value->size() != 1) {
    return Client::fail(recognizer_public_path + ": expected one public key");
  }
  return Client::ok({std::move(*own.value), std::move(server.value->front())});
}

}  // namespace palpate::client
