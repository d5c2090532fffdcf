// X-ray mirrors: what palpate says beside what they were designed to be.
#pragma once

#include <filesystem>
#include <ostream>

namespace palpate::bench {

/// Tables in markdown for the mirrors of folder/design.json (tests/data/real/README.md). Throws
/// std::runtime_error where a file cannot be read.
void print_mirrors(const std::filesystem::path& folder, std::ostream& out);

}  // namespace palpate::bench
