// SIGINT and SIGTERM as something to poll.
#pragma once

#include <poll.h>
#include <pthread.h>
#include <sys/signalfd.h>
#include <unistd.h>

#include <csignal>

namespace palpate {

/// Blocks the stop signals, to be read from the returned descriptor; -1 where there is none. Call
/// it before any thread starts, so that every thread (libzmq's too) has them blocked.
inline int take_stop_signals() {
  sigset_t signals;
  sigemptyset(&signals);
  sigaddset(&signals, SIGINT);
  sigaddset(&signals, SIGTERM);
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK);
}

/// Whether a stop has been asked for.
inline bool stop_requested(int stop_fd) {
  pollfd stop{stop_fd, POLLIN, 0};
  return ::poll(&stop, 1, 0) > 0;
}

}  // namespace palpate
