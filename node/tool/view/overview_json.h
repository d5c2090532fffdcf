// JSON of the overview that a browser is sent a few times a second.
#pragma once

#include "node/tool/view/json_text.h"
#include "node/tool/view/live_state.h"

namespace palpate {

/// Lists all groups, probes and recognizers with their ages.
void write_overview(const LiveState& state, SteadyTime now, JsonText& json);

}  // namespace palpate
