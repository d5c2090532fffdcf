// Tells systemd that the program serves, that it is alive, and that it ends. Uses the protocol that
// sd_notify(3) describes, without its library. Does nothing without a service manager.
#pragma once

#include <sys/socket.h>
#include <sys/un.h>
#include <unistd.h>

#include <chrono>
#include <cstddef>
#include <cstdlib>
#include <cstring>
#include <string>
#include <string_view>

namespace palpate {

class ServiceManager {
 public:
  using Time = std::chrono::steady_clock::time_point;

  /// Reads the address and the watchdog interval that the service manager has put into the
  /// environment.
  ServiceManager() {
    const char* address = std::getenv("NOTIFY_SOCKET");
    // "/path", or "@name" for Linux's abstract names.
    const std::string_view path = address == nullptr ? "" : address;
    if (path.size() < 2 || path.size() >= sizeof address_.sun_path) return;
    if (path.front() != '/' && path.front() != '@') return;
    address_.sun_family = AF_UNIX;
    std::memcpy(address_.sun_path, path.data(), path.size());
    if (path.front() == '@') address_.sun_path[0] = '\0';
    address_bytes_ = static_cast<socklen_t>(offsetof(sockaddr_un, sun_path) + path.size());
    fd_ = ::socket(AF_UNIX, SOCK_DGRAM | SOCK_CLOEXEC | SOCK_NONBLOCK, 0);
    const char* watchdog = std::getenv("WATCHDOG_USEC");
    const char* whose = std::getenv("WATCHDOG_PID");
    const bool ours = whose == nullptr || std::strtoll(whose, nullptr, 10) == ::getpid();
    // Half of the watchdog interval, as sd_watchdog_enabled(3) advises.
    if (watchdog != nullptr && ours) {
      period_ = std::chrono::microseconds(std::strtoll(watchdog, nullptr, 10) / 2);
    }
  }
  ~ServiceManager() {
    if (fd_ >= 0) ::close(fd_);
  }
  ServiceManager(const ServiceManager&) = delete;
  ServiceManager& operator=(const ServiceManager&) = delete;

  void ready(const std::string& status) const { tell("READY=1\nSTATUS=" + status); }
  void stopping() const { tell("STOPPING=1"); }

  /// Reports that the program is alive, no more often than necessary.
  void alive(Time now) {
    if (period_.count() <= 0 || now < next_) return;
    next_ = now + period_;
    tell("WATCHDOG=1");
  }

 private:
  // Failures are ignored: the program must run without a listening manager.
  void tell(std::string_view text) const {
    if (fd_ < 0) return;
    (void)::sendto(fd_, text.data(), text.size(), MSG_NOSIGNAL,
                   reinterpret_cast<const sockaddr*>(&address_), address_bytes_);
  }

  sockaddr_un address_{};
  socklen_t address_bytes_ = 0;
  int fd_ = -1;
  std::chrono::microseconds period_{0};
  Time next_{};
};

}  // namespace palpate
