// What a browser shows in words, numbers and charts: it is read, and so comes a few times a second.
#pragma once

#include "node/tool/drawing/drawing.h"
#include "node/tool/view/json_text.h"
#include "node/tool/view/live_state.h"

namespace palpate {

/// "recognized", "ambiguous" or "collecting".
const char* status_word(const v1::Recognition& answer);

/// Words, quantities, hypotheses, the tree's path, charts and residuals of a group's answer;
/// coordinates in steps from its origin. `drawing` is that of the group, with the curvature along
/// its curves.
void write_details(LiveGroup& group, const Drawing& drawing, SteadyTime now, JsonText& json);

}  // namespace palpate
