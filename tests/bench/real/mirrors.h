// X-ray mirrors: palpate's answers compared with their designs.
#pragma once

#include <filesystem>
#include <ostream>

namespace palpate::bench {

/// Prints tables in markdown for the mirrors of folder/design.json (tests/data/real/README.md).
/// Throws std::runtime_error if a file cannot be read.
void print_mirrors(const std::filesystem::path& folder, std::ostream& out);

}  // namespace palpate::bench
