// What can be had of a group: what it is, to save it; what it was, to look at it again.
#pragma once

#include <cstdint>
#include <string>
#include <string_view>

#include "node/tool/view/live_state.h"

namespace palpate {

/// Its samples, as palpate fit reads them; a comment says where some were dropped.
std::string samples_csv(const LiveGroup& group);

/// Its answer, in the wire contract's JSON.
std::string answer_json(const LiveGroup& group);

/// Times of the moments of a group that can be looked at again, as JSON. [Unix time, ms]
std::string moments_json(LiveState& state, std::string_view group);

/// The moment nearest to a time as a message of the live feed, and its own time; empty where there
/// is none.
std::string moment_json(const LiveState& state, std::string_view group, std::int64_t time_ms,
                        SteadyTime now);

}  // namespace palpate
