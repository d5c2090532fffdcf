// Whole files that programs write.
#pragma once

#include <unistd.h>

#include <cerrno>
#include <cstdio>
#include <cstring>
#include <fstream>
#include <iostream>
#include <string>

namespace palpate {

/// "PATH: cannot be written: why", of the error that the system has told last; errno must have
/// been 0 before the file was opened.
inline std::string cannot_be_written(const std::string& path) {
  const std::string why = path + ": cannot be written";
  return errno != 0 ? why + ": " + std::strerror(errno) : why;
}

/// Makes sure that all of standard output is written. What is wrong, or nothing.
inline std::string flush_standard_output() {
  errno = 0;
  if (std::cout.flush() && std::fflush(stdout) == 0 && std::ferror(stdout) == 0) return {};
  // What has failed before is not tried again, and why is not known any more: a further line end,
  // after output that is broken off, has the same fate.
  if (errno == 0) (void)!::write(STDOUT_FILENO, "\n", 1);
  return cannot_be_written("standard output");
}

/// Writes it in place of what is there. What is wrong, or nothing.
inline std::string write_file(const std::string& path, const std::string& text) {
  errno = 0;
  std::ofstream file(path, std::ios::trunc);
  return file << text << std::flush ? std::string() : cannot_be_written(path);
}

}  // namespace palpate
