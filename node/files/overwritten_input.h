// Keeps programs from writing over what they read.
#pragma once

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

}  // namespace palpate
