#include "tests/support/test_rng.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstdlib>
#include <string>

namespace palpate::test {
namespace {

std::uint64_t environment_number(const char* name, std::uint64_t fallback) {
  const char* text = std::getenv(name);
  return text == nullptr ? fallback : std::strtoull(text, nullptr, 10);
}

double stress() {
  const char* text = std::getenv("PALPATE_TEST_STRESS");
  return text == nullptr ? 1.0 : std::strtod(text, nullptr);
}

}  // namespace

std::uint64_t test_seed() {
  std::string name = "none";
  if (const auto* info = ::testing::UnitTest::GetInstance()->current_test_info()) {
    name = std::string(info->test_suite_name()) + "." + info->name();
  }
  std::uint64_t hash = 14695981039346656037ULL;  // FNV-1a: the same on every platform
  for (const char c : name) {
    hash = (hash ^ static_cast<unsigned char>(c)) * 1099511628211ULL;
  }
  const std::uint64_t seed = hash + environment_number("PALPATE_TEST_SEED", 0);
  ::testing::Test::RecordProperty("seed", std::to_string(seed));
  return seed;
}

std::mt19937_64 test_rng(std::uint64_t stream) {
  return seeded_rng(test_seed(),
                    {static_cast<std::uint32_t>(stream), static_cast<std::uint32_t>(stream >> 32)});
}

int stress_count(int base) { return std::max(1, static_cast<int>(std::ceil(base * stress()))); }

bool counts_tell() { return stress() >= 1.0; }

}  // namespace palpate::test
