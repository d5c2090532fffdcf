// CURVE keys and their files: certificates as CZMQ and pyzmq write and read them (ZPL, ZeroMQ's RFC
// 4), so that either side may have created its own.
//
//     metadata
//     curve
//         public-key = "KEY"
//         secret-key = "KEY"
//
// KEY is in Z85 (40 characters). A public file has no secret key. Several public files, one after
// the other, make an allow-clients file. Bare lines "public-key KEY" and "KEY" are accepted too;
// empty lines and lines that begin with '#' are skipped. In an allow-clients file, a list of probes
// may follow a key: the client may publish under these names only. Without a list it may publish
// under any name, with "probes=" under none:
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

/// A client that may connect, and its rights.
struct AllowedClient {
  std::string public_key;            ///< Z85
  std::optional<ProbeNames> probes;  ///< names it may publish under; nullopt = any
};

/// False if libzmq was built without CURVE. Nothing below works then.
bool curve_available();

/// Creates a pair of keys from the system's random source.
Result<CurveKeyPair> generate_curve_keys();

/// Writes both keys to `secret_path` (mode 0600) and the public key to `public_path` (mode 0644).
/// Never overwrites a file. Returns an empty string or an error.
std::string write_curve_keys(const CurveKeyPair& keys, const std::string& secret_path,
                             const std::string& public_path);

/// Reads a secret key file. Fails if it holds none, if other users may read it, or if its keys do
/// not match.
Result<CurveKeyPair> read_curve_keys(const std::string& secret_path);

/// Reads all public keys of a file, at least one: a public key file, or several together. Ignores
/// rights.
Result<std::vector<std::string>> read_public_keys(const std::string& path);

/// Reads the clients of an allow-clients file: at least one, no duplicates.
Result<std::vector<AllowedClient>> read_allowed_clients(const std::string& path);

}  // namespace palpate
