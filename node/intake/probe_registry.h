// All known probes with their health, within a fixed bound.
#pragma once

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>

#include "node/intake/rate_meter.h"
#include "node/intake/sequence_tracker.h"
#include "node/process/clock.h"

namespace palpate {

struct Probe {
  std::string name;
  std::string group;  ///< of its latest message
  SequenceTracker sequence;
  std::optional<std::uint64_t> object;  ///< in its latest message
  SteadyTime last_heard;
  bool alive = true;
  std::uint64_t messages = 0;  ///< accepted
  std::uint64_t samples = 0;   ///< accepted
  std::uint64_t rejected = 0;
  RateMeter message_rate;
  RateMeter sample_rate;
  std::int64_t latency_ns = 0;  ///< of the latest message, from publication to arrival
  enum class Told { Nothing, Up, Silent };
  Told told = Told::Nothing;  ///< what the log last said about it
};

class ProbeRegistry {
 public:
  /// `evict_idle`: a probe silent for longer may be forgotten to make room. Active probes are never
  /// evicted, so a flood of invented names cannot displace a real probe.
  ProbeRegistry(std::size_t max_probes, std::chrono::duration<double> evict_idle)
      : max_probes_(max_probes), evict_idle_(evict_idle) {}

  Probe* find(std::string_view name);

  /// True if add() would find room.
  bool has_room(SteadyTime now) const;

  /// Adds a new probe. If there is no room, it replaces the probe silent for longest, whose name
  /// goes to `evicted`. Needs has_room().
  Probe& add(std::string_view name, SteadyTime now, std::string& evicted);

  const std::map<std::string, Probe, std::less<>>& all() const { return probes_; }
  std::map<std::string, Probe, std::less<>>& all() { return probes_; }

  std::uint64_t evicted_count() const { return evicted_count_; }

  /// Sums over all probes, including those forgotten.
  std::uint64_t gaps() const;
  std::uint64_t missing() const;
  std::uint64_t restarts() const;

 private:
  std::map<std::string, Probe, std::less<>>::const_iterator most_idle() const;

  std::size_t max_probes_;
  std::chrono::duration<double> evict_idle_;
  std::map<std::string, Probe, std::less<>> probes_;
  std::uint64_t evicted_count_ = 0;
  std::uint64_t evicted_gaps_ = 0;
  std::uint64_t evicted_missing_ = 0;
  std::uint64_t evicted_restarts_ = 0;
};

}  // namespace palpate
