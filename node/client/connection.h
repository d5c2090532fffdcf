// How a client (a probe or a planner) connects to the recognizer.
#pragma once

#include <optional>
#include <string>
#include <zmq.hpp>

#include "node/files/result.h"
#include "node/wire/socket.h"

namespace palpate::client {

/// Reads the keys of a CURVE connection: the client's own secret key file, and the recognizer's
/// public one. Fails if either is not named: with one alone nothing would be secret.
Result<CurveClient> read_curve_client(const std::string& own_secret_path,
                                      const std::string& recognizer_public_path);

}  // namespace palpate::client
