// Counts the calls of operator new in a test program.
#pragma once

#include <cstddef>

namespace palpate::test {

/// Number of calls of operator new so far. Only a test program that calls this function is linked
/// with the counting operator new.
std::size_t allocation_count();

}  // namespace palpate::test
