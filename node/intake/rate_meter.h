// Events per second, averaged over the last second.
#pragma once

#include <algorithm>
#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>

namespace palpate {

class RateMeter {
 public:
  using Time = std::chrono::steady_clock::time_point;

  void add(Time now, std::uint64_t count) {
    advance(now);
    buckets_[place_of(current_)] += count;
  }

  /// Mean over the last second; of the current tenth only the elapsed part counts.
  double per_second(Time now) {
    advance(now);
    std::uint64_t sum = 0;
    for (const std::uint64_t bucket : buckets_) sum += bucket;
    // A time before the latest event is that of the event's tenth.
    const std::chrono::duration<double> partial =
        std::max(now.time_since_epoch() - current_ * kBucket, Time::duration(0));
    const std::chrono::duration<double> full = (kBuckets - 1) * kBucket;
    return static_cast<double>(sum) / (full + partial).count();
  }

 private:
  static constexpr std::size_t kBuckets = 11;  // ten full ones and the one being filled
  static constexpr std::chrono::milliseconds kBucket{100};

  void advance(Time now) {
    const std::int64_t index = now.time_since_epoch() / kBucket;
    if (index - current_ >= static_cast<std::int64_t>(kBuckets)) {
      buckets_.fill(0);
      current_ = index;
    }
    while (current_ < index) buckets_[place_of(++current_)] = 0;
  }

  static std::size_t place_of(std::int64_t bucket) {
    return static_cast<std::size_t>(bucket) % kBuckets;
  }

  std::array<std::uint64_t, kBuckets> buckets_{};
  std::int64_t current_ = 0;  // bucket being filled, counted from the clock's start
};

}  // namespace palpate
