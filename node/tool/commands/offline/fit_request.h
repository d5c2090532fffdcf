// What palpate fit is asked for.
#pragma once

#include <string>
#include <vector>

#include "core/recognition/recognizer.h"
#include "node/tool/commands/file_flags.h"
#include "node/wire/recognizer_options.h"

namespace palpate {

struct FitRequest {
  std::vector<std::string> files;
  std::string format;
  std::string plot;
  std::string invariants_plot;
  std::string curve_file;
  std::string part;
  std::string given_class;
  std::vector<std::string> probe_files;
  std::vector<std::string> left_out;  ///< numbers, and ranges of them
  FileFlags file;
  std::vector<std::string> said;  ///< names of the recogniser's options that were given
  RecognizerWords words;
  RecognizerOptions recognizer;
};

}  // namespace palpate
