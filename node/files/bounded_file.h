// Reads whole files of unknown origin, up to a length limit.
#pragma once

#include <fcntl.h>
#include <sys/stat.h>
#include <unistd.h>

#include <algorithm>
#include <cerrno>
#include <cstddef>
#include <cstring>
#include <string>

#include "node/files/result.h"

namespace palpate {

/// Reads from a descriptor to its end. Pipes work too. Fails if there are more than `most_bytes`.
/// An error reads "NAME: cannot be read: why".
inline Result<std::string> read_bounded(int fd, const std::string& name, std::size_t most_bytes) {
  const auto fail = [&](const std::string& why) {
    return Result<std::string>::fail(name + ": cannot be read: " + why);
  };
  struct stat info {};
  if (::fstat(fd, &info) != 0) return fail(std::strerror(errno));
  if (S_ISDIR(info.st_mode)) return fail("is a directory");
  const std::string too_long = "longer than " + std::to_string(most_bytes) + " bytes";
  constexpr std::size_t kChunk = 64 * 1024;
  const auto told = static_cast<std::size_t>(std::max<off_t>(info.st_size, 0));
  if (told > most_bytes) return fail(too_long);
  std::string text;
  for (std::size_t length = 0;;) {
    text.resize(std::max({length + kChunk, told + 1, text.size()}));
    const ssize_t got = ::read(fd, text.data() + length, text.size() - length);
    if (got < 0 && errno == EINTR) continue;
    if (got < 0) return fail(std::strerror(errno));
    length += static_cast<std::size_t>(got);
    if (length > most_bytes) return fail(too_long);
    if (got > 0) continue;
    text.resize(length);
    return Result<std::string>::ok(std::move(text));
  }
}

/// Reads a whole file.
inline Result<std::string> read_bounded(const std::string& path, std::size_t most_bytes) {
  const int fd = ::open(path.c_str(), O_RDONLY | O_CLOEXEC);
  if (fd < 0) {
    return Result<std::string>::fail(path + ": cannot be read: " + std::strerror(errno));
  }
  Result<std::string> text = read_bounded(fd, path, most_bytes);
  ::close(fd);
  return text;
}

}  // namespace palpate
