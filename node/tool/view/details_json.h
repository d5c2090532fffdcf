// What a browser shows in words, numbers and charts: it is read, and so comes a few times a second.
#pragma once

#include <nlohmann/json.hpp>

#include "node/tool/view/live_state.h"

namespace palpate {

/// "recognized", "ambiguous" or "collecting".
const char* status_word(const v1::Recognition& answer);

/// Words, quantities, hypotheses, the tree's path, charts and residuals of a group's answer;
/// coordinates in steps from its origin.
nlohmann::json details_json(LiveGroup& group, SteadyTime now);

}  // namespace palpate
