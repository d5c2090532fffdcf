// SIGINT and SIGTERM as a descriptor to poll.
#pragma once

#include <poll.h>
#include <pthread.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <csignal>

namespace palpate {

/// Blocks the stop signals and returns a descriptor to read them from; -1 on failure. Call it
/// before any thread starts, so that every thread (libzmq's too) blocks them.
inline int take_stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK);
}

/// True if a stop has been requested.
inline bool stop_requested(int stop_fd) {
  pollfd stop{stop_fd, POLLIN, 0};
  return ::poll(&stop, 1, 0) > 0;
}

}  // namespace palpate
