// SIGINT and SIGTERM as a descriptor to poll.
#pragma once

#include <poll.h>

#include <csignal>

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

}  // namespace palpate
