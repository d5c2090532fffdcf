// Whole files that programs write.
#pragma once

#include <cerrno>
#include <cstring>
#include <fstream>
#include <string>

namespace palpate {

/// "PATH: cannot be written: why", of the error that the system has told last; errno must have
/// been 0 before the file was opened.
inline std::string cannot_be_written(const std::string& path) {
  const std::string why = path + ": cannot be written";
  return errno != 0 ? why + ": " + std::strerror(errno) : why;
}

/// Writes it in place of what is there. What is wrong, or nothing.
inline std::string write_file(const std::string& path, const std::string& text) {
  errno = 0;
  std::ofstream file(path, std::ios::trunc);
  return file << text << std::flush ? std::string() : cannot_be_written(path);
}

}  // namespace palpate
