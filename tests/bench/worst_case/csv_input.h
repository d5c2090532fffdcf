// Inputs of the recogniser from CSV files.
#pragma once

#include <optional>
#include <string>

#include "tests/bench/worst_case/touched_input.h"

namespace palpate::bench {

/// The samples in the order of the file, as the tool feeds them; all groups and objects of a file
/// are one here. nullopt where it cannot be read, which is said on stderr.
std::optional<TouchedInput> input_from(const std::string& path);

}  // namespace palpate::bench
