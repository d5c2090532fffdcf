// Makes sure that an ipc:// path has only one owner.
#pragma once

#include <string>

#include "node/files/result.h"

namespace palpate {

/// Holds an exclusive lock on PATH.lock, a file next to the socket. Without it, a second bind on an
/// ipc path would succeed and take the path from its owner. The kernel releases the lock when the
/// process ends, in whatever way.
class PathLock {
 public:
  /// Fails if another process, or another PathLock of this one, holds the lock.
  static Result<PathLock> acquire(const std::string& path);

  PathLock() = default;  ///< holds nothing
  PathLock(PathLock&& other) noexcept;
  PathLock& operator=(PathLock&& other) noexcept;
  ~PathLock();

 private:
  explicit PathLock(int fd) : fd_(fd) {}

  int fd_ = -1;
};

/// The file path of an ipc:// address; empty for other transports and for abstract names.
std::string ipc_path(const std::string& address);

}  // namespace palpate
