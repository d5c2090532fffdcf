// Processor time of the calling thread. A busy machine changes it far less than elapsed time.
#pragma once

#include <ctime>

namespace palpate::bench {

/// [us]
inline double thread_us() {
  timespec now{};
  clock_gettime(CLOCK_THREAD_CPUTIME_ID, &now);
  return 1e6 * static_cast<double>(now.tv_sec) + 1e-3 * static_cast<double>(now.tv_nsec);
}

}  // namespace palpate::bench
