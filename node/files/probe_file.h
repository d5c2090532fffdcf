// Probe files: what a probe does to positions, as text.
#pragma once

#include <string>

#include "core/qualification/probe_character.h"
#include "node/files/result.h"
#include "palpate/v1/probe.pb.h"

namespace palpate {

/// A probe file that has been read.
struct QualifiedProbe {
  std::string file;
  v1::Probe described;
  ProbeCharacter character;
};

/// An error reads "FILE:LINE: FIELD: what is wrong", or "FILE:LINE:COLUMN: what is wrong" where it
/// is no message at all.
Result<QualifiedProbe> read_probe(const std::string& path);

/// The same from text; `name` stands for the file in errors.
Result<QualifiedProbe> parse_probe(const std::string& text, const std::string& name);

/// The numbers of a character, in `probe`.
void to_wire(const ProbeCharacter& character, v1::Probe& probe);

/// A whole file, with a line that says what it is.
std::string probe_text(const v1::Probe& probe);

}  // namespace palpate
