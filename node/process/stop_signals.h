// SIGINT and SIGTERM as a descriptor to poll.
#pragma once

#include <poll.h>

#include <algorithm>
#include <chrono>
#include <csignal>
#include <cstdint>

#include "node/process/clock.h"
#include "node/process/take_signals.h"

namespace palpate {

/// Blocks the stop signals and returns a descriptor to read them from. Call it before any thread
/// starts, so that every thread (libzmq's too) blocks them. Ends the program if the system provides
/// no descriptor: nothing else could.
inline int take_stop_signals() { return take_signals({SIGINT, SIGTERM}); }

/// True if a stop has been requested.
inline bool stop_requested(int stop_fd) {
  pollfd stop{stop_fd, POLLIN, 0};
  return ::poll(&stop, 1, 0) > 0;
}

/// Waits until then; true as soon as a stop has been requested.
inline bool stop_requested_before(SteadyTime due, int stop_fd) {
  using std::chrono::nanoseconds;
  constexpr std::int64_t kNanosecondsPerSecond = 1'000'000'000;
  pollfd stop{stop_fd, POLLIN, 0};
  for (;;) {
    const std::int64_t left_ns = std::max(nanoseconds(due - now_steady()), nanoseconds(0)).count();
    const timespec timeout{left_ns / kNanosecondsPerSecond, left_ns % kNanosecondsPerSecond};
    if (::ppoll(&stop, 1, &timeout, nullptr) > 0) return true;
    if (left_ns == 0) return false;
  }
}

}  // namespace palpate
