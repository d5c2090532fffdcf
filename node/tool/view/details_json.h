// JSON of what a browser shows as words, numbers and charts. A person reads it, so it is sent only
// a few times a second.
#pragma once

#include "node/tool/drawing/drawing.h"
#include "node/tool/view/json_text.h"
#include "node/tool/view/live_state.h"

namespace palpate {

/// "recognized", "ambiguous" or "collecting".
const char* status_word(const v1::Recognition& answer);

/// Writes words, quantities, hypotheses, the tree's path, charts and residuals of a group's answer.
/// Coordinates are in steps from its origin. `drawing` must be that of the group, with
/// Curvature::Along.
void write_details(LiveGroup& group, const Drawing& drawing, SteadyTime now, JsonText& json);

}  // namespace palpate
