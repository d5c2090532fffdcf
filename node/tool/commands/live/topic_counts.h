// What arrives on the results endpoint, topic by topic.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "node/tool/commands/command.h"
#include "node/tool/commands/live/topic_count.h"

namespace palpate {

/// Subscribes to everything and counts, until `until` says so (asked after every message and at
/// least every 50 ms).
Result<std::map<std::string, TopicCount>> count_topics(
    const Connection& connection,
    const std::function<bool(const std::map<std::string, TopicCount>&)>& until);

}  // namespace palpate
