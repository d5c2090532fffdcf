// Random numbers that are the same on every machine. The C++ standard fixes its engines but not its
// distributions, so the distributions are our own.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>

#include "core/curves/pose2.h"

namespace palpate::sim {

class Random {
 public:
  /// Different streams of one seed are independent.
  Random(std::uint64_t seed, std::uint64_t stream) {
    const auto low = [](std::uint64_t v) { return static_cast<std::uint32_t>(v); };
    std::seed_seq sequence{low(seed), low(seed >> 32), low(stream), low(stream >> 32)};
    engine_.seed(sequence);
  }

  /// Uniform in [0, 1), with all 53 bits.
  double uniform() { return static_cast<double>(engine_() >> 11) * 0x1p-53; }

  /// Two independent standard normal numbers (G. Marsaglia's polar method).
  Vec2 normal_pair() {
    for (;;) {
      const Vec2 point(2.0 * uniform() - 1.0, 2.0 * uniform() - 1.0);
      const double square = point.squaredNorm();
      if (square > 0.0 && square < 1.0) {
        return point * std::sqrt(-2.0 * std::log(square) / square);
      }
    }
  }

 private:
  std::mt19937_64 engine_;
};

}  // namespace palpate::sim
