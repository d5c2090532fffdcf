// Keeps programs from writing over what they read, or have written.
#pragma once

#include <cstddef>
#include <filesystem>
#include <span>
#include <string>
#include <system_error>

#include "node/files/printable.h"

namespace palpate {

/// What is wrong if `output` is a file that is read too, by whatever name or link; else nothing.
/// Among `inputs` "-" is standard input. Empty paths are none.
inline std::string overwrites_input(const std::string& output,
                                    std::span<const std::string> inputs) {
  std::error_code none;
  // Terminals and pipes are read and written at once, and lose nothing.
  if (output.empty() || !std::filesystem::is_regular_file(output, none)) return "";
  for (const std::string& input : inputs) {
    const bool is_stdin = input == "-";
    const std::filesystem::path read = is_stdin ? "/dev/stdin" : input;
    if (input.empty() || !std::filesystem::equivalent(output, read, none) || none) continue;
    return printable_path(output) + ": not written: it is the file that is read" +
           (is_stdin          ? " as standard input"
            : input != output ? " as " + printable_path(input)
                              : "") +
           "; give the output another name";
  }
  return "";
}

/// What is wrong if two of `outputs` are one file, by whatever name; else nothing. Empty paths are
/// none, nor are devices and pipes, such as /dev/null; "-" is standard output.
inline std::string overwrites_output(std::span<const std::string> outputs) {
  std::error_code none;
  const auto is_same = [&](const std::string& a, const std::string& b) {
    if (a.empty() || b.empty() || std::filesystem::is_other(a, none)) return false;
    return std::filesystem::weakly_canonical(a, none) == std::filesystem::weakly_canonical(b, none);
  };
  for (std::size_t i = 0; i < outputs.size(); ++i) {
    for (std::size_t k = 0; k < i; ++k) {
      if (is_same(outputs[i], outputs[k])) {
        return printable_path(outputs[i]) +
               ": not written: two outputs have this name; give one of them another";
      }
    }
  }
  return "";
}

}  // namespace palpate
