// The clocks and the epoch number of this process.
#pragma once

#include <chrono>
#include <cstdint>
#include <random>

namespace palpate {

/// Unix time. [ns]
inline std::int64_t unix_time_ns() {
  return std::chrono::duration_cast<std::chrono::nanoseconds>(
             std::chrono::system_clock::now().time_since_epoch())
      .count();
}

/// A clock that is never adjusted.
using SteadyTime = std::chrono::steady_clock::time_point;
inline SteadyTime now_steady() { return std::chrono::steady_clock::now(); }

/// 64 random bits: a number that no earlier process has used.
inline std::uint64_t random_epoch() {
  std::random_device device;
  return (static_cast<std::uint64_t>(device()) << 32) | device();
}

}  // namespace palpate
