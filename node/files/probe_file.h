// Reads and writes probe files (palpate/v1/probe.proto): how a probe's positions differ from the
// true ones.
#pragma once

#include <string>

#include "core/qualification/probe_character.h"
#include "node/files/result.h"
#include "palpate/v1/probe.pb.h"

namespace palpate {

/// A probe file after reading.
struct QualifiedProbe {
  std::string file;
  v1::Probe described;
  ProbeCharacter character;
};

/// Reads a probe file. An error reads "FILE:LINE: FIELD: what is wrong", or "FILE:LINE:COLUMN: what
/// is wrong" if the text cannot be parsed.
Result<QualifiedProbe> read_probe(const std::string& path);

/// The same from text; `name` stands for the file in errors.
Result<QualifiedProbe> parse_probe(const std::string& text, const std::string& name);

/// Copies the numbers of `character` into `probe`.
void to_wire(const ProbeCharacter& character, v1::Probe& probe);

/// The text of a probe file, with a first line that says what it is.
std::string probe_text(const v1::Probe& probe);

}  // namespace palpate
