// What can be saved of a group.
#pragma once

#include <string>

#include "node/tool/view/live_state.h"

namespace palpate {

/// Its samples, as palpate fit reads them; a comment says where some were dropped.
std::string samples_csv(const LiveGroup& group);

/// Its answer, in the wire contract's JSON.
std::string answer_json(const LiveGroup& group);

}  // namespace palpate
