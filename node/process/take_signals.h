// Signals as a descriptor to poll.
#pragma once

#include <pthread.h>
#include <sys/signalfd.h>

#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <initializer_list>

namespace palpate {

/// Blocks the signals in this thread and those that it starts, and returns a descriptor to read
/// them from. Without one they could neither be read nor end the program: it ends here.
inline int take_signals(std::initializer_list<int> numbers) {
  sigset_t signals;
  sigemptyset(&signals);
  for (const int number : numbers) sigaddset(&signals, number);
  const int fd = ::signalfd(-1, &signals, SFD_CLOEXEC | SFD_NONBLOCK);
  if (fd < 0) {
    std::perror("no descriptor for signals");
    std::exit(EXIT_FAILURE);
  }
  pthread_sigmask(SIG_BLOCK, &signals, nullptr);
  return fd;
}

}  // namespace palpate
