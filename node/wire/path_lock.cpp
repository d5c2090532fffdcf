#include "node/wire/path_lock.h"

#include <fcntl.h>
#include <sys/file.h>
#include <unistd.h>

#include <cerrno>
#include <cstring>
#include <string_view>
#include <utility>

namespace palpate {

Result<PathLock> PathLock::acquire(const std::string& path) {
  const std::string lock_path = path + ".lock";
  constexpr mode_t kPrivate = 0600;
  const int fd = ::open(lock_path.c_str(), O_RDWR | O_CREAT | O_CLOEXEC, kPrivate);
  if (fd < 0) return Result<PathLock>::fail(lock_path + ": " + std::strerror(errno));
  if (::flock(fd, LOCK_EX | LOCK_NB) != 0) {
    const std::string why =
        errno == EWOULDBLOCK ? "another process has bound it" : std::strerror(errno);
    ::close(fd);
    return Result<PathLock>::fail(path + ": " + why);
  }
  // The file remains when the lock is released: removing it would let two processes lock two files.
  return Result<PathLock>::ok(PathLock(fd));
}

PathLock::PathLock(PathLock&& other) noexcept : fd_(std::exchange(other.fd_, -1)) {}

PathLock& PathLock::operator=(PathLock&& other) noexcept {
  std::swap(fd_, other.fd_);
  return *this;
}

PathLock::~PathLock() {
  if (fd_ >= 0) ::close(fd_);
}

std::string ipc_path(const std::string& address) {
  constexpr std::string_view kIpcScheme = "ipc://";
  if (!address.starts_with(kIpcScheme)) return {};
  std::string path = address.substr(kIpcScheme.size());
  // "ipc://*" chooses a path itself; "@name" is not in the file system.
  if (path.empty() || path.front() == '@' || path == "*") return {};
  return path;
}

}  // namespace palpate
