// Files and moments of a group that a browser can request.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "node/tool/view/live_state.h"

namespace palpate {

/// The samples in the format that `palpate fit` reads. A comment says where some were dropped.
std::string samples_csv(const LiveGroup& group);

/// The answer in the wire contract's JSON.
std::string answer_json(const LiveGroup& group);

/// The times of a group's moments that can be shown again, as JSON. [Unix time, ms]
std::string moments_json(LiveState& state, std::string_view group);

/// The moment nearest to a time, as a message of the live feed with the moment's own time; empty if
/// there is none.
std::string moment_json(const LiveState& state, std::string_view group, std::int64_t time_ms,
                        SteadyTime now);

}  // namespace palpate
