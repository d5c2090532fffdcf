// An eventfd: one thread rings, another waits for it or polls it.
#pragma once

#include <sys/eventfd.h>
#include <unistd.h>

#include <stdexcept>

namespace palpate {

class Bell {
 public:
  enum class Hearing { Waits, AtOnce };

  /// Throws std::runtime_error if the system provides no descriptor.
  explicit Bell(Hearing hearing)
      : fd_(::eventfd(0, EFD_CLOEXEC | (hearing == Hearing::AtOnce ? EFD_NONBLOCK : 0))) {
    if (fd_ < 0) throw std::runtime_error("no eventfd");
  }
  ~Bell() { ::close(fd_); }
  Bell(const Bell&) = delete;
  Bell& operator=(const Bell&) = delete;

  void ring() const { (void)::eventfd_write(fd_, 1); }

  /// Takes all rings since the last call. Hearing::Waits: waits for one if there was none.
  void hear() const {
    eventfd_t count = 0;
    (void)::eventfd_read(fd_, &count);
  }

  /// Readable from a ring until it is heard.
  int fd() const { return fd_; }

 private:
  const int fd_;
};

}  // namespace palpate
