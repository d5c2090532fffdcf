// One owner for an ipc:// path.
#pragma once

#include <string>

#include "node/files/result.h"

namespace palpate {

/// Holds an exclusive lock on a file beside the socket, PATH.lock, for its lifetime: a second bind
/// on an ipc path would silently succeed and steal it. The kernel frees the lock with the process,
/// however that ends.
class PathLock {
 public:
  /// Fails where another process, or another lock in this one, holds it.
  static Result<PathLock> acquire(const std::string& path);

  PathLock() = default;  ///< holds nothing
  PathLock(PathLock&& other) noexcept;
  PathLock& operator=(PathLock&& other) noexcept;
  ~PathLock();

 private:
  explicit PathLock(int fd) : fd_(fd) {}

  int fd_ = -1;
};

/// Path in the file system of an ipc:// address; empty for other transports and abstract names.
std::string ipc_path(const std::string& address);

}  // namespace palpate
