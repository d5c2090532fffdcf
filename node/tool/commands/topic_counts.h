// What arrives on the results endpoint, topic by topic.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>

#include "node/tool/commands/command.h"

namespace palpate {

struct TopicCount {
  std::uint64_t messages = 0;  ///< each once
  std::uint64_t repeats = 0;   ///< of the latest answer, for planners that come late
  std::uint64_t bytes = 0;
  std::chrono::steady_clock::time_point first;
  std::chrono::steady_clock::time_point last;
  double shortest_s = 0.0;  ///< between two messages
  double longest_s = 0.0;

  /// Messages a second between the first and the last; 0 for fewer than two.
  double rate_hz() const;
  void take(std::string_view payload, std::chrono::steady_clock::time_point now);

 private:
  std::uint64_t epoch_ = 0;
  std::uint64_t seq_ = 0;
};

/// Subscribes to everything and counts, until `until` says so (asked after every message and at
/// least every 50 ms).
Result<std::map<std::string, TopicCount>> count_topics(
    const Connection& connection,
    const std::function<bool(const std::map<std::string, TopicCount>&)>& until);

}  // namespace palpate
