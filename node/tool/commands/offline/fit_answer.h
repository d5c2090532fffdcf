// The answer of palpate fit to one group and object.
#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "node/tool/commands/offline/fit_input.h"
#include "node/tool/commands/offline/fit_request.h"
#include "node/tool/commands/offline/object_answer.h"
#include "node/tool/text/advice.h"

namespace palpate {

struct FitAnswer {
  v1::Recognition answer;
  std::string text;                ///< report or JSON line, without notes
  std::vector<std::string> notes;  ///< said on standard error too, but for those of the input
  bool is_found = false;           ///< of a class, for sure
  std::vector<Vec2> spikes_m;
  ContactGroup measured;  ///< the samples, as the answer has them (measured_group.h)
  Stated stated;
  std::optional<Recognition> recognition;  ///< in full, if no class is given
};

/// `left_out`: samples that do not count, numbered from 1 as the file has them. `json`: the text is
/// a JSON line.
FitAnswer fit_answer(const FitRequest& fit, FitInput input, const ProbeFiles& probes,
                     const std::vector<std::size_t>& left_out, bool json);

}  // namespace palpate
