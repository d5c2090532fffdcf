// Decides which process serves which place. A place is a partition of a cell's groups; one
// recognizer at a time should serve it.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "node/gateway/plant/plant.h"

namespace palpate::gateway {

/// The owner of a place announces it every kPeriod; a process that has not heard of an owner for a
/// while takes the place. This is not a lock: two processes may both believe that they own a place.
/// Correctness does not depend on it, because the plant stores an answer only after the one that
/// its recognizer knows as the last (place.h). So this can be simple, and it works while a stream
/// has no leader.
class Claims {
 public:
  static constexpr std::chrono::milliseconds kPeriod{100};
  /// An owner that is silent for this long (five announcements lost) counts as gone. Together with
  /// the random waiting time and the time to begin, a group is answered again well within two
  /// seconds.
  static constexpr std::chrono::milliseconds kSilence{500};

  /// Wait after taking a place, to hear of a process that took it at the same moment.
  static constexpr std::chrono::milliseconds kSettle{100};

  struct Changes {
    std::vector<std::string> take;
    std::vector<std::string> release;
  };

  /// `places`: those that this process may take. `most`: how many of them at a time.
  Claims(std::uint64_t own_id, std::vector<std::string> places, std::size_t most, SteadyTime now);

  /// Process `id` announces that it owns `place`.
  void hear(std::string_view place, std::uint64_t id, SteadyTime now);

  /// Which places to take and to release now. `is_heard`: whether others can hear us.
  Changes decide(bool is_heard, SteadyTime now);

  /// The places to announce.
  std::vector<std::string> own() const;

  std::uint64_t id() const { return id_; }

 private:
  struct Claim {
    bool is_own = false;
    bool is_contested = false;  // by an owner with a smaller id, which takes precedence
    SteadyTime last_heard;
    std::chrono::milliseconds patience{0};
  };

  std::chrono::milliseconds some_patience();

  std::uint64_t id_;
  std::size_t most_;
  std::map<std::string, Claim, std::less<>> claims_;
  SteadyTime last_heard_of_us_;
  std::uint64_t random_state_;
};

}  // namespace palpate::gateway
