// How often messages of one topic arrive.
#pragma once

#include <chrono>
#include <cstdint>
#include <string_view>

#include "palpate/v1/header.pb.h"

namespace palpate {

/// The header, with which every message of the contract begins, whatever else it is. False if it
/// has none.
bool header_of(std::string_view payload, v1::Header& header);

class TopicCount {
 public:
  using Time = std::chrono::steady_clock::time_point;

  std::uint64_t messages = 0;  ///< each once
  std::uint64_t repeats = 0;   ///< of the latest answer, for planners that come late
  std::uint64_t bytes = 0;
  double shortest_s = 0.0;  ///< between two messages
  double longest_s = 0.0;

  void take(std::string_view payload, Time now);
  /// Messages a second between the first and the last; 0 for fewer than two, and once they have
  /// stopped.
  double rate_hz(Time now) const;
  /// How long nothing has come, not even a repeat; 0 while that is no longer than usual.
  double silence_s(Time now) const;

 private:
  /// `since` lies so far back that more should have come.
  bool has_stopped(Time since, Time now) const;

  Time first_;
  Time last_;
  Time last_of_all_;  ///< repeats too
  std::uint64_t epoch_ = 0;
  std::uint64_t seq_ = 0;
};

}  // namespace palpate
