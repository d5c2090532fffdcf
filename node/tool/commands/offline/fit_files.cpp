#include "node/tool/commands/offline/fit_files.h"

#include <string>
#include <utility>

#include "node/check/group_check.h"
#include "node/tool/commands/command.h"
#include "node/tool/commands/offline/left_out.h"

namespace palpate {
namespace {

/// Says what there is to say of an input beside its answer.
void tell_of(FitInput* input, const FitRequest& fit) {
  const std::string whose = input->group.file + ": " + object_of(input->group, input->is_alone);
  for (const std::string& warning : input->warnings) {
    complain("WARNING: " + whose + warning, kDone);
  }
  std::string note = note_of_unused_sigma(input->group, fit.recognizer.sigma_m);
  if (!note.empty()) {
    complain(whose + note, kDone);
    // Placing says its notes here, not beside its answers.
    if (fit.part.empty()) input->notes.push_back(std::move(note));
  }
}

}  // namespace

std::optional<FitFiles> read_fit_files(const FitRequest& fit) {
  FitFiles files;
  bool bad = false;
  Result<ProbeFiles> probes = ProbeFiles::read(fit.probe_files);
  if (!probes) {
    complain(probes.error, kUsage);
    return std::nullopt;
  }
  files.probes = *std::move(probes.value);
  for (const std::string& file : fit.files) {
    Result<std::vector<FitInput>> read =
        read_fit_input(file, options_of(fit.file), fit.recognizer.sigma_m);
    if (!read) {
      complain(read.error, kUsage);
      bad = true;
      continue;
    }
    for (FitInput& input : *read.value) {
      tell_of(&input, fit);
      files.inputs.push_back(std::move(input));
    }
  }
  if (bad) return std::nullopt;
  if (!fit.left_out.empty()) {
    if (files.inputs.size() != 1) {
      complain("--leave-out: for one group and object only, here are " +
                   std::to_string(files.inputs.size()),
               kUsage);
      return std::nullopt;
    }
    Result<std::vector<std::size_t>> numbers =
        left_out_of(fit.left_out, files.inputs.front().group);
    if (!numbers) {
      complain(numbers.error, kUsage);
      return std::nullopt;
    }
    files.left_out = *std::move(numbers.value);
  }
  return files;
}

}  // namespace palpate
