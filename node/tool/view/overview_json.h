// What a browser is told of everything there is, a few times a second.
#pragma once

#include <nlohmann/json.hpp>

#include "node/tool/view/live_state.h"

namespace palpate {

/// Lists all groups, probes and recognizers, with their ages.
nlohmann::json overview_json(const LiveState& state, SteadyTime now);

}  // namespace palpate
