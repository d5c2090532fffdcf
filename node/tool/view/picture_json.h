// What a browser is sent, as JSON. Every text from the bus stays text: it is escaped here and
// becomes a text node there.
#pragma once

#include <cstdint>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "node/tool/view/live_state.h"

namespace palpate {

/// Lists all groups, probes and recognizers, with their ages.
nlohmann::json overview_json(const LiveState& state, SteadyTime now);

/// Answer and drawing of one group; coordinates in metres relative to its origin.
nlohmann::json picture_json(LiveGroup& group, SteadyTime now);

/// Which of a group's samples a browser has.
struct SentSamples {
  std::uint64_t generation = 0;
  std::vector<std::size_t> of_run;
};

/// The samples that it has not, runs continued where they ended; null where it has them all. Brings
/// `sent` up to date.
nlohmann::json samples_json(const LiveGroup& group, SentSamples& sent);

/// As text; what is not UTF-8 is replaced.
std::string to_text(const nlohmann::json& message);

}  // namespace palpate
