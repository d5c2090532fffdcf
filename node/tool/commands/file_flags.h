// How a file of contacts is to be read, as the subcommands that read one ask it.
#pragma once

#include <CLI/CLI.hpp>
#include <string>

#include "node/csv/contact_file.h"

namespace palpate {

struct FileFlags {
  std::string unit;
  std::string plane = "auto";
  bool touches = false;
  bool strokes = false;
  double tip_radius_m = 0.0;
};

void add_file_flags(CLI::App& command, FileFlags& flags);

ContactFileOptions options_of(const FileFlags& flags);

}  // namespace palpate
