// Quantiles of the computing times of one reporting period.
#pragma once

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <cstdint>
#include <vector>

namespace palpate {

class ComputeTimes {
 public:
  void add(std::int64_t nanoseconds) {
    if (times_.size() < kKept) {
      times_.push_back(nanoseconds);
    } else {
      times_[next_++ % kKept] = nanoseconds;
    }
  }

  /// The q-quantile of the times, q in [0, 1]; 0 if there are none.
  std::int64_t quantile(double q) {
    if (times_.empty()) return 0;
    const auto nth = times_.begin() + std::lround(q * static_cast<double>(times_.size() - 1));
    std::nth_element(times_.begin(), nth, times_.end());
    return *nth;
  }

  void clear() {
    times_.clear();
    next_ = 0;
  }

 private:
  static constexpr std::size_t kKept = 4096;  // if a period has more, the latest are kept

  std::vector<std::int64_t> times_;
  std::size_t next_ = 0;
};

}  // namespace palpate
