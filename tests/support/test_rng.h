// Repeatable randomness for tests: the seed comes from the suite's and test's names, so that a
// test sees the same numbers alone, in any order and on any machine.
#pragma once

#include <cstdint>
#include <random>

namespace palpate::test {

/// Seed of the running GoogleTest: a hash of "Suite.Test" plus PALPATE_TEST_SEED from the
/// environment (default 0). A failing test prints it.
std::uint64_t test_seed();

/// Generator seeded by test_seed(); `stream` separates independent sequences within one test.
std::mt19937_64 test_rng(std::uint64_t stream = 0);

/// Number of random cases: `base` times PALPATE_TEST_STRESS (default 1) from the environment.
int stress_count(int base);

}  // namespace palpate::test
