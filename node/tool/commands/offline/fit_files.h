// What palpate fit reads, all of it before anything is answered: a bad file costs no half-done
// work.
#pragma once

#include <cstddef>
#include <optional>
#include <vector>

#include "node/files/probe_files.h"
#include "node/tool/commands/offline/fit_input.h"
#include "node/tool/commands/offline/fit_request.h"

namespace palpate {

struct FitFiles {
  ProbeFiles probes;
  std::vector<FitInput> inputs;
  std::vector<std::size_t> left_out;  ///< samples of the only input, numbered from 1
};

/// nullopt where anything of it is wrong, which standard error says.
std::optional<FitFiles> read_fit_files(const FitRequest& fit);

}  // namespace palpate
