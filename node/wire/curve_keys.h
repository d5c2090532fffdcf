// CURVE keys and their files: certificates as CZMQ and pyzmq write and read them (ZPL, ZeroMQ's
// RFC 4), so that each side may have made its own.
//
//     metadata
//     curve
//         public-key = "KEY"
//         secret-key = "KEY"
//
// KEY in Z85 (40 characters). A public file has no secret key; several of them, one after the
// other, are an allow-clients file. Bare lines "public-key KEY" and "KEY" are read too, empty lines
// and lines that begin with '#' skipped. In an allow-clients file the probes as which a client may
// publish can follow its key; without them it may publish as all, with "probes=" as none:
//
//     KEY probes=left,right
#pragma once

#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "node/files/result.h"

namespace palpate {

struct CurveKeyPair {
  std::string public_key;  ///< Z85
  std::string secret_key;  ///< Z85
};

using ProbeNames = std::set<std::string, std::less<>>;

/// Who may connect, and what it may do there.
struct AllowedClient {
  std::string public_key;            ///< Z85
  std::optional<ProbeNames> probes;  ///< as which it may publish; nullopt = any
};

/// False where libzmq was built without CURVE: nothing below works then.
bool curve_available();

/// A fresh pair from the system's random source.
Result<CurveKeyPair> generate_curve_keys();

/// Writes both keys to `secret_path` (mode 0600) and the public key to `public_path` (mode 0644).
/// Never overwrites. Returns an empty string, or what went wrong.
std::string write_curve_keys(const CurveKeyPair& keys, const std::string& secret_path,
                             const std::string& public_path);

/// Reads a secret key file. Fails where others may read it, or where the keys do not match.
Result<CurveKeyPair> read_curve_keys(const std::string& secret_path);

/// All public keys of a file, at least one. A public key file or several; without rights.
Result<std::vector<std::string>> read_public_keys(const std::string& path);

/// The clients of an allow-clients file, at least one, each once.
Result<std::vector<AllowedClient>> read_allowed_clients(const std::string& path);

}  // namespace palpate
