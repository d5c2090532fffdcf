// What systemd is told (sd_notify(3), which describes this protocol for programs without its
// library): that the program serves, that it is alive, that it ends. Without a service manager
// nothing is said.
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

  /// From the environment, where the service manager says where it listens and how often it wants
  /// to hear from us.
  ServiceManager() {
    const char* address = std::getenv("NOTIFY_SOCKET");
    // "/path" or, of Linux's abstract names, "@name".
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
    // Half of what it waits, as sd_watchdog_enabled(3) advises.
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

  /// Alive: said no more often than it must be.
  void alive(Time now) {
    if (period_.count() <= 0 || now < next_) return;
    next_ = now + period_;
    tell("WATCHDOG=1");
  }

 private:
  // A manager that does not listen is none of our trouble.
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
