// Repeatable random numbers for tests. The seed depends on the names of suite and test only, so
// that a test gets the same numbers alone, in any order and on any machine.
#pragma once

#include <cmath>
#include <cstdint>
#include <initializer_list>
#include <random>
#include <vector>

namespace palpate::test {

/// Seed of the running GoogleTest: a hash of "Suite.Test" plus PALPATE_TEST_SEED from the
/// environment (default 0). A failing test prints it.
std::uint64_t test_seed();

/// A generator for the case that `which` numbers, its words after the seed's low and high half:
/// different cases of one seed are independent.
inline std::mt19937_64 seeded_rng(std::uint64_t seed, std::initializer_list<std::uint32_t> which) {
  std::vector<std::uint32_t> words{static_cast<std::uint32_t>(seed),
                                   static_cast<std::uint32_t>(seed >> 32)};
  words.insert(words.end(), which);
  std::seed_seq sequence(words.begin(), words.end());
  return std::mt19937_64(sequence);
}

/// A generator seeded by test_seed(). `stream` separates independent sequences within one test.
std::mt19937_64 test_rng(std::uint64_t stream = 0);

inline double uniform(std::mt19937_64& rng, double least, double most) {
  return std::uniform_real_distribution<double>(least, most)(rng);
}

inline double log_uniform(std::mt19937_64& rng, double least, double most) {
  return std::exp(uniform(rng, std::log(least), std::log(most)));
}

inline double random_sign(std::mt19937_64& rng) {
  return uniform(rng, -1.0, 1.0) < 0.0 ? -1.0 : 1.0;
}

/// Number of random cases: `base` times PALPATE_TEST_STRESS (default 1) from the environment, at
/// least one. With a sanitizer it is a fraction: the same code on fewer scenes.
int stress_count(int base);

/// True if there are enough cases for bounds on counts and means, so not if only a fraction of them
/// runs. Requirements on single cases are checked in any run.
bool counts_tell();

}  // namespace palpate::test
