// Who has which place: a partition of a cell's groups that one recogniser at a time is to take.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <string_view>
#include <vector>

#include "node/gateway/plant.h"

namespace palpate::gateway {

/// Who has a place says so aloud, and whoever has not heard of an owner for a while takes it. That
/// is no lock: two may believe that a place is theirs. Exactness does not rest on it but on the
/// plant storing an answer only after the one that its recogniser knows as the last (place.h); so
/// this may be simple, and works on while a stream looks for a leader.
class Claims {
 public:
  static constexpr std::chrono::milliseconds kPeriod{100};
  /// Silence after which an owner is gone: five words of it lost. With what those who wait differ
  /// by and the time to begin, a group is answered again well within two seconds.
  static constexpr std::chrono::milliseconds kSilence{500};

  /// After taking a place, within which one who took it at the same moment has been heard.
  static constexpr std::chrono::milliseconds kSettle{100};

  struct Changes {
    std::vector<std::string> take;
    std::vector<std::string> release;
  };

  /// `places`: those that this process may take; `most`: so many at a time.
  Claims(std::uint64_t own_id, std::vector<std::string> places, std::size_t most, SteadyTime now);

  /// Somebody says that he has it.
  void hear(std::string_view place, std::uint64_t id, SteadyTime now);

  /// What is to be taken and to be let go by now. `is_heard`: whether others could hear us.
  Changes decide(bool is_heard, SteadyTime now);

  /// The places to speak up for.
  std::vector<std::string> own() const;

  std::uint64_t id() const { return id_; }

 private:
  struct Claim {
    bool is_own = false;
    bool is_contested = false;  // by one who goes first
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
