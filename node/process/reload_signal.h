// SIGHUP as a descriptor to poll: asks the program to read its key and probe files again.
#pragma once

#include <pthread.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <csignal>

namespace palpate {

/// Blocks SIGHUP and returns a descriptor to read it from; -1 on failure. Call it before any thread
/// starts.
inline int take_reload_signal() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGHUP);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK);
}

/// True if a reload has been requested since the last call.
inline bool reload_requested(int reload_fd) {
  signalfd_siginfo info{};
  bool asked = false;
  while (::read(reload_fd, &info, sizeof info) == static_cast<ssize_t>(sizeof info)) asked = true;
  return asked;
}

}  // namespace palpate
