// Counts the program's allocations through operator new.
#pragma once

#include <cstddef>

namespace palpate::test {

/// Calls of operator new so far. A test program that asks has the counting operator new, others
/// have the standard one.
std::size_t allocation_count();

}  // namespace palpate::test
