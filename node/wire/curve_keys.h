// CURVE keys and their files.
//
// A key file is text: lines "public-key KEY" and "secret-key KEY", KEY in Z85 (40 characters);
// empty lines and lines that begin with '#' are skipped. A public file has the first line only;
// several of them, one after the other, are an allow-clients file.
#pragma once

#include <string>
#include <vector>

#include "node/files/result.h"

namespace palpate {

struct CurveKeyPair {
  std::string public_key;  ///< Z85
  std::string secret_key;  ///< Z85
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

/// All public keys of a file, at least one. A public key file or an allow-clients file.
Result<std::vector<std::string>> read_public_keys(const std::string& path);

}  // namespace palpate
