// SIGHUP as something to poll: reread what may change while the program runs.
#pragma once

#include <pthread.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <csignal>

namespace palpate {

/// Blocks SIGHUP, to be read from the returned descriptor; -1 where there is none. Call it before
/// any thread starts.
inline int take_reload_signal() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK);
}

/// Whether a reload has been asked for since the last call.
inline bool reload_requested(int reload_fd) {
  signalfd_siginfo info{};
  bool asked = false;
  while (::read(reload_fd, &info, sizeof info) == static_cast<ssize_t>(sizeof info)) asked = true;
  return asked;
}

}  // namespace palpate
