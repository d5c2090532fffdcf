// SIGHUP as a descriptor to poll: asks the program to read its key and probe files again.
#pragma once

#include <sys/signalfd.h>
#include <unistd.h>

#include <csignal>

#include "node/process/take_signals.h"

namespace palpate {

/// Blocks SIGHUP and returns a descriptor to read it from, as take_stop_signals() does.
inline int take_reload_signal() { return take_signals({SIGHUP}); }

/// True if a reload has been requested since the last call.
inline bool reload_requested(int reload_fd) {
  signalfd_siginfo info{};
  bool asked = false;
  while (::read(reload_fd, &info, sizeof info) == static_cast<ssize_t>(sizeof info)) asked = true;
  return asked;
}

}  // namespace palpate
