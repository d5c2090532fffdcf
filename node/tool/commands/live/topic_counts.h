// What arrives on the results endpoint, topic by topic.
#pragma once

#include <functional>
#include <map>
#include <string>

#include "node/tool/commands/command.h"
#include "node/tool/commands/live/topic_count.h"

namespace palpate {

struct TopicCounts {
  std::map<std::string, TopicCount> by_topic;
  std::string refusal;  ///< why the recognizer refuses us, which ends the count; empty if not
};

/// Subscribes to everything and counts, until `until` says so (asked after every message and at
/// least every 50 ms). Fails where the connection cannot be one.
Result<TopicCounts> count_topics(
    const Connection& connection,
    const std::function<bool(const std::map<std::string, TopicCount>&)>& until);

}  // namespace palpate
